# Compiler settings shared by every target: warnings are errors, the instruction set is pinned, floating point is IEEE.
add_library(palpate_compiler INTERFACE)
target_include_directories(palpate_compiler INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(palpate_compiler INTERFACE
  -march=x86-64-v3          # one instruction set for everyone: part of the bit-determinism promise
  -ffp-contract=off         # a*b+c rounds twice everywhere
  -fno-math-errno           # sqrt is one instruction; changes no result
  -Wall -Wextra -Wpedantic -Werror -Wconversion -Wdouble-promotion -Wshadow -Wvla -Wold-style-cast)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(palpate_compiler INTERFACE -Wno-attributes)
endif()
