#!/usr/bin/env bash
# Instructions on AArch64 of each scene's worst tick under the scripted hand, as tests/bench counts them on x86-64.
# Usage: tick_count.sh TICK_COUNT IMAGE_DIR
set -euo pipefail
program=${1:?usage: tick_count.sh TICK_COUNT IMAGE_DIR} images=${2:?usage: tick_count.sh TICK_COUNT IMAGE_DIR}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
gcc -O2 -Wall -Wextra -Werror -shared -fPIC "$here/count_plugin.c" -o "$work/count.so"
for image in "$images"/*.pal; do
  printf '%-26s' "$(basename "$image" .pal)"
  "$here/emulator.sh" -plugin "$work/count.so" "$program" "$image" 2>&1
done
