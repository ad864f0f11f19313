// What a refused input says.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/support/refusal.h"

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)
