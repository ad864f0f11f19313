#!/usr/bin/env bash
# The bit-determinism promise between processors: state_hash of both builds ticks the same baked scenes and must print the
# same hashes of every tick's state and output. Usage: same_bits.sh RELEASE_BUILD_DIR AARCH64_BUILD_DIR JOBS
set -euo pipefail
usage='usage: same_bits.sh RELEASE_BUILD_DIR AARCH64_BUILD_DIR JOBS'
release=${1:?$usage} aarch64=${2:?$usage} jobs=${3:?$usage}
here=$(cd "$(dirname "$0")" && pwd)
results=$aarch64/same_bits
rm -rf "$results" && mkdir -p "$results"
program=tests/determinism/state_hash
images=("$release"/scenes/*.pal)
# A file for each scene: processes that print at once would mix their lines.
printf '%s\0' "${images[@]}" | xargs -0 -P "$jobs" -I IMAGE sh -c '"$0" "$2" >"$1/$(basename "$2").x86-64"' "$release/$program" "$results" IMAGE
printf '%s\0' "${images[@]}" | xargs -0 -P "$jobs" -I IMAGE sh -c '"$0" "$1" "$3" >"$2/$(basename "$3").aarch64"' "$here/emulator.sh" \
  "$aarch64/$program" "$results" IMAGE
for processor in x86-64 aarch64; do cat "$results"/*.pal.$processor >"$results/$processor.txt"; done
"$here/../determinism/compare.sh" "$results/x86-64.txt" "$results/aarch64.txt"
