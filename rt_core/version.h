// Version of Palpate (semantic versioning; docs/library.md says what it covers). CMake reads it from here.
#pragma once

#define PALPATE_VERSION_MAJOR 0
#define PALPATE_VERSION_MINOR 1
#define PALPATE_VERSION_PATCH 0
#define PALPATE_VERSION (PALPATE_VERSION_MAJOR * 10000 + PALPATE_VERSION_MINOR * 100 + PALPATE_VERSION_PATCH)
