#!/usr/bin/env bash
# Proves that the compile-time analysis refuses a blocking call below a real-time function, and accepts clean code.
# Usage: function_effects.sh CLANG ROOT
set -euo pipefail
clang=${1:?usage: function_effects.sh CLANG ROOT}
root=${2:?usage: function_effects.sh CLANG ROOT}
check() {
  "$clang" -std=c++20 -march=x86-64-v3 -fsyntax-only -Wfunction-effects -Werror=function-effects -I"$root" -x c++ - 2>&1
}
clean='#include "rt_core/vec.h"
double f(palpate::Vec3 v) PALPATE_RT { return palpate::norm(v); }'
blocking='#include "rt_core/base.h"
int* helper() { return new int(1); }
int f() PALPATE_RT { return *helper(); }'
check <<<"$clean" || { echo "clean real-time code was refused"; exit 1; }
if message=$(check <<<"$blocking"); then
  echo "an allocation below a real-time function was accepted"
  exit 1
fi
grep -q 'function-effects' <<<"$message" || { echo "refused, but not by the function-effect analysis: $message"; exit 1; }
echo "function effects: the analysis refuses an allocation and accepts clean code"
