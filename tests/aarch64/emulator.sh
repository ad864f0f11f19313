#!/usr/bin/env bash
# Runs a program that was built for AArch64 with the libraries of build/aarch64-libraries. Usage: emulator.sh PROGRAM [ARGUMENT...]
set -euo pipefail
libraries=$(cd "$(dirname "$0")/../../build/aarch64-libraries" && pwd)
exec qemu-aarch64 -L /usr/aarch64-linux-gnu \
  -E "LD_LIBRARY_PATH=$libraries/usr/lib/aarch64-linux-gnu:$libraries/lib/aarch64-linux-gnu" "$@"
