# Compiler settings shared by every target: warnings are errors, the instruction set is pinned, floating point is IEEE.
if(NOT CMAKE_SYSTEM_NAME STREQUAL "Linux" OR NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|aarch64)$")
  message(FATAL_ERROR "Palpate runs on Linux on x86-64 processors, its controller on AArch64 too; this is "
    "${CMAKE_SYSTEM_NAME} on ${CMAKE_SYSTEM_PROCESSOR}.")
endif()
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  # Advanced SIMD is in every one. char is signed, as on x86-64.
  set(palpate_instructions -march=armv8-a -fsigned-char)
  set(palpate_unfused -ffp-contract=off)
else()
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-march=x86-64-v3 PALPATE_COMPILER_KNOWS_V3)
  if(NOT PALPATE_COMPILER_KNOWS_V3)
    message(FATAL_ERROR "This compiler (${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}) does not know "
      "-march=x86-64-v3. Use g++ 11 or newer, or clang 12 or newer: cmake -DCMAKE_CXX_COMPILER=g++ ...")
  endif()
  set(palpate_instructions -march=x86-64-v3)
  # gcc 12 -O3 makes vfmaddsub of a*b-c, a*b+c pairs in spite of the first (seen 2026-11-21).
  set(palpate_unfused -ffp-contract=off -mno-fma)
endif()

add_library(palpate_compiler INTERFACE)
target_compile_features(palpate_compiler INTERFACE cxx_std_20)
target_include_directories(palpate_compiler INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
  $<INSTALL_INTERFACE:include/palpate>)
target_compile_options(palpate_compiler INTERFACE
  ${palpate_instructions}   # one instruction set for everyone: part of the bit-determinism promise
  ${palpate_unfused}        # a*b+c rounds twice everywhere
  -fno-math-errno)          # sqrt is one instruction; changes no result
# Ours alone: a project that takes this one in is not asked to meet them.
if(PROJECT_IS_TOP_LEVEL)
  target_compile_options(palpate_compiler INTERFACE $<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;-Wconversion;-Wsign-conversion;-Wdouble-promotion;-Wshadow;-Wvla;-Wold-style-cast>)
endif()
if(PALPATE_WERROR)
  target_compile_options(palpate_compiler INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
# Library functions are looked up at start, not at their first call, which could come in the middle of a tick.
target_link_options(palpate_compiler INTERFACE -Wl,-z,now)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # -Wattributes: gcc does not know clang's nonblocking attribute. -Wrestrict: false alarm of gcc 12 in std::string's
  # operator+ when inlined (GCC bug 105651).
  target_compile_options(palpate_compiler INTERFACE -Wno-attributes $<BUILD_INTERFACE:-Wno-restrict>)
endif()

if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # std::stable_sort of gcc 12's library uses a function it declares deprecated itself; gcc still checks our own calls.
  target_compile_options(palpate_compiler INTERFACE $<BUILD_INTERFACE:-Wno-deprecated-declarations>)
endif()

# Run-time checks. The first finding ends the program, so that a test cannot pass over it.
if(PALPATE_SANITIZE STREQUAL "address")
  # Without null: a null pointer that is followed ends under the address sanitizer as well, and the checks are an eighth
  # of the build (75 s of 84 s for ten files, gcc 12, 2026-11-22).
  set(palpate_sanitize_flags -fsanitize=address,undefined -fno-sanitize=null -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # gcc's documentation: the sanitizers' extra code makes this warning unreliable. The plain build keeps it.
    target_compile_options(palpate_compiler INTERFACE -Wno-maybe-uninitialized)
  endif()
elseif(PALPATE_SANITIZE STREQUAL "thread")
  set(palpate_sanitize_flags -fsanitize=thread -fno-omit-frame-pointer)
elseif(PALPATE_SANITIZE STREQUAL "realtime")
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang" OR CMAKE_CXX_COMPILER_VERSION VERSION_LESS 20)
    message(FATAL_ERROR "PALPATE_SANITIZE=realtime needs clang 20 or newer: cmake --preset rtsan")
  endif()
  set(palpate_sanitize_flags -fsanitize=realtime -fno-omit-frame-pointer)
elseif(PALPATE_SANITIZE)
  message(FATAL_ERROR "PALPATE_SANITIZE=${PALPATE_SANITIZE}: allowed are address, thread, realtime, or nothing.")
endif()
if(PALPATE_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "PALPATE_FUZZ needs clang's libFuzzer: cmake --preset fuzz")
  endif()
  target_compile_options(palpate_compiler INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(palpate_sanitize_flags)
  target_compile_definitions(palpate_compiler INTERFACE PALPATE_SANITIZED)
  target_compile_options(palpate_compiler INTERFACE ${palpate_sanitize_flags})
  target_link_options(palpate_compiler INTERFACE ${palpate_sanitize_flags})
endif()

# For what is compiled more often than it is run, tests and the programs' commands: less optimisation, but where Eigen
# does the work. Seconds for tests/host/test_verdict.cpp: release 11.8 at -O3, 7.2 at -O1; address sanitizer 22.5 at -O1,
# 9.4 at -O0; for test_elastic_tick.cpp 4.9, 3.5, 5.9, 4.0 (gcc 12, 2026-11-24). Results are the same bits, as
# tests/determinism proves for -O1; the libraries keep their -O3.
set(palpate_quick_compile -O1)
if(PALPATE_SANITIZE)
  set(palpate_quick_compile -O0)
endif()
string(TOUPPER "${CMAKE_BUILD_TYPE}" palpate_build_type)
string(REGEX MATCH "-O[^ ]+" palpate_full_compile "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${palpate_build_type}}")
# A target's sources: `with` that include Eigen, and `without`.
function(palpate_sources_by_eigen target)
  set(with)
  set(without)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    if(source MATCHES "\\.cpp$")
      get_filename_component(path ${source} ABSOLUTE)
      file(STRINGS ${path} eigen REGEX "include <Eigen")
      if(eigen)
        list(APPEND with ${source})
      else()
        list(APPEND without ${source})
      endif()
    endif()
  endforeach()
  set(with ${with} PARENT_SCOPE)
  set(without ${without} PARENT_SCOPE)
endfunction()
function(palpate_compile_fully) # SOURCE...: of a target that is compiled quickly
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS ${palpate_full_compile})
  set_property(SOURCE ${ARGN} PROPERTY SKIP_PRECOMPILE_HEADERS ON) # which are of one level of optimisation
endfunction()
function(palpate_compile_quickly target)
  if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    return()
  endif()
  target_compile_options(${target} PRIVATE ${palpate_quick_compile})
  palpate_sources_by_eigen(${target})
  foreach(source ${with})
    palpate_compile_fully(${source})
  endforeach()
endfunction()

# Sources are compiled together, some four in one, for most of what a small one takes is the headers it includes: four of
# tests/hal 16.2 s of processor time one by one and 8.8 as one, of config 20.4 and 15.6 (gcc 12, 2026-11-27); all of the
# address sanitizer's build 1,230 and 940 (clang 22, 2026-11-28). By their names' hash, so that one more source moves no
# other. Those with Eigen take long by themselves; of APART, each a regular expression, names are those of others (cards
# have functions of one name each). Debug builds (cmake --preset dev, which ./run test --long makes) compile each source by
# itself, so what forgets an include does not compile there.
function(palpate_compile_together target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "APART")
  if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    return()
  endif()
  palpate_sources_by_eigen(${target})
  foreach(pattern ${arg_APART})
    list(FILTER without EXCLUDE REGEX "${pattern}")
  endforeach()
  list(LENGTH without count)
  set(groups 1)
  set(most 6)
  while(count GREATER most)
    math(EXPR groups "2 * ${groups}")
    math(EXPR most "2 * ${most}")
  endwhile()
  foreach(source ${without})
    get_filename_component(name ${source} NAME)
    string(MD5 hash ${name})
    string(SUBSTRING ${hash} 0 4 hash)
    math(EXPR group "0x${hash} % ${groups}")
    set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# Headers that nearly every source of a target includes, read once for all of them: for sanitizers, which are clang's.
# Debug builds do without, so a source that forgets an include does not compile there. Processor seconds under the address
# sanitizer without and with: config/fem/tet_element.cpp 3.8 and 2.4, config/body/body_pose.cpp 0.8 and 0.3,
# sim_host/bake/explain.cpp 5.2 and 4.2 (2026-11-26).
function(palpate_read_once target)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND PALPATE_SANITIZE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <cstring> <filesystem> <fstream>
      <functional> <map> <memory> <numeric> <optional> <random> <span> <sstream> <string> <thread> <vector> ${ARGN})
  endif()
endfunction()
