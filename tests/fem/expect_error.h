// What a refused input says.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "config/scene/config_error.h"

namespace palpate {

template <class Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}
#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

}  // namespace palpate
