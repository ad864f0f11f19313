# Builds for AArch64 on Debian 12 with g++-aarch64-linux-gnu. The libraries are those that libraries.sh unpacked; headers
# and settings that are the same for every processor come from the machine itself. Programs run under qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

set(palpate_libraries ${CMAKE_CURRENT_LIST_DIR}/../../build/aarch64-libraries)
cmake_path(NORMAL_PATH palpate_libraries)
set(palpate_library_folder ${palpate_libraries}/usr/lib/aarch64-linux-gnu)
if(NOT EXISTS ${palpate_library_folder}/pkgconfig/ccd.pc)
  message(FATAL_ERROR "The libraries for AArch64 are not in ${palpate_libraries}: tests/aarch64/libraries.sh ${palpate_libraries}")
endif()
set(CMAKE_FIND_ROOT_PATH ${palpate_libraries})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE BOTH)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)
set(ENV{PKG_CONFIG_LIBDIR} ${palpate_library_folder}/pkgconfig)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${palpate_libraries})
set(CMAKE_EXE_LINKER_FLAGS_INIT -Wl,-rpath-link,${palpate_library_folder}:${palpate_libraries}/lib/aarch64-linux-gnu)  # libraries of libraries

set(CMAKE_CROSSCOMPILING_EMULATOR ${CMAKE_CURRENT_LIST_DIR}/emulator.sh)
