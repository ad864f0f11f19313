#!/usr/bin/env bash
# The bit-determinism promise, tested: four builds (gcc and clang, -O1 and -O3) tick the same baked scenes and must print
# the same hashes; a recording made by the first must replay to the same bits in all of them.
# Usage: matrix.sh RELEASE_BUILD_DIR JOBS     (the release build is gcc -O3; the others are built beside it)
set -euo pipefail
release=${1:?usage: matrix.sh RELEASE_BUILD_DIR JOBS} jobs=${2:?usage: matrix.sh RELEASE_BUILD_DIR JOBS}
root=$(cd "$(dirname "$0")/../.." && pwd)
release=$(cd "$release" && pwd)
base=$(dirname "$release")
results=$release/determinism
mkdir -p "$results"
rm -f "$results"/*

build() { # NAME COMPILER LEVEL
  local options=()
  ! command -v ccache >/dev/null || options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  cmake -S "$root" -B "$base/determinism-$1" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$2" \
    -DCMAKE_CXX_FLAGS_RELEASE="$3 -DNDEBUG" "${options[@]}"
  cmake --build "$base/determinism-$1" -j "$jobs" --target state_hash palpate
}
build gcc-O1 g++ -O1
build clang-O1 clang++-22 -O1
build clang-O3 clang++-22 -O3
declare -A builds=([gcc-O3]=$release [gcc-O1]=$base/determinism-gcc-O1
  [clang-O1]=$base/determinism-clang-O1 [clang-O3]=$base/determinism-clang-O3)

images=("$release"/scenes/*.pal)
for image in "${images[@]}"; do
  scene=$(basename "$image" .pal)
  "$release/bin/palpate" run "$root/config/scenes/$scene.toml" --device loopback --duration 3 --quiet \
    --image "$results/$scene.pal" --record "$results/$scene.plr" || echo "the run of $scene ended with a fault; it must replay all the same"
done
status=0
for name in gcc-O3 gcc-O1 clang-O1 clang-O3; do
  "${builds[$name]}/tests/determinism/state_hash" "${images[@]}" >"$results/$name.txt" || status=1
  for recording in "$results"/*.plr; do
    echo "$name replays $(basename "$recording")"
    "${builds[$name]}/bin/palpate" replay "$recording" || status=1
  done
done
"$root/tests/determinism/compare.sh" "$results"/gcc-O3.txt "$results"/gcc-O1.txt "$results"/clang-O1.txt "$results"/clang-O3.txt ||
  status=1
exit "$status"
