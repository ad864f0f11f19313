#!/usr/bin/env bash
# The bit-determinism promise, tested: four builds (gcc and clang, -O1 and -O3) tick the same baked scenes and must print
# the same hashes; a recording made by the first must replay to the same bits in all of them.
# Usage: matrix.sh RELEASE_BUILD_DIR JOBS [NAME=BUILD_DIR...]
# The release build is gcc -O3; the others are built beside it, but for those given: a sanitizer's build is one of -O1 and
# computes the same arithmetic, as in `matrix.sh build/release 2 gcc-O1=build/asan clang-O1=build/rtsan`.
# shellcheck disable=SC2317  # called through each()
set -euo pipefail
release=${1:?usage: matrix.sh RELEASE_BUILD_DIR JOBS [NAME=BUILD_DIR...]} jobs=${2:?usage: matrix.sh RELEASE_BUILD_DIR JOBS [NAME=BUILD_DIR...]}
shift 2
root=$(cd "$(dirname "$0")/../.." && pwd)
release=$(cd "$release" && pwd)
base=$(dirname "$release")
results=$release/determinism
mkdir -p "$results"
rm -f "$results"/*

declare -A builds=([gcc-O3]=$release)
for given in "$@"; do
  builds[${given%%=*}]=$(cd "${given#*=}" && pwd)
done

build() { # NAME COMPILER LEVEL
  local options=()
  [ -z "${builds[$1]:-}" ] || return 0
  builds[$1]=$base/determinism-$1
  ! command -v ccache >/dev/null || options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  cmake -S "$root" -B "$base/determinism-$1" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$2" \
    -DCMAKE_CXX_FLAGS_RELEASE="$3 -DNDEBUG" "${options[@]}"
  cmake --build "$base/determinism-$1" -j "$jobs" --target state_hash replay_bits
}
build gcc-O1 g++ -O1
build clang-O1 clang++-22 -O1
build clang-O3 clang++-22 -O3

each() { # FUNCTION ITEM...: as many at a time as there are jobs; fails if one failed
  local function=$1 item pids=() failed=0
  shift
  for item in "$@"; do
    [ "${#pids[@]}" -lt "$jobs" ] || { wait "${pids[0]}" || failed=1; pids=("${pids[@]:1}"); }
    "$function" "$item" &
    pids+=($!)
  done
  for item in "${pids[@]}"; do wait "$item" || failed=1; done
  return "$failed"
}

record() { # IMAGE: three seconds of its scene
  local scene
  scene=$(basename "$1" .pal)
  "$release/bin/palpate" run "$root/config/scenes/$scene.toml" --device loopback --duration 3 --quiet \
    --image "$results/$scene.pal" --record "$results/$scene.plr" || echo "the run of $scene ended with a fault; it must replay all the same"
}

replay() { # RECORDING
  local said
  if said=$("${builds[$name]}/tests/determinism/replay_bits" "$1" 2>&1); then
    echo "$name: $said"
  else
    echo "$name: $(basename "$1"): $said"
    return 1
  fi
}

images=("$release"/scenes/*.pal)
status=0
each record "${images[@]}"
for name in gcc-O3 gcc-O1 clang-O1 clang-O3; do
  "${builds[$name]}/tests/determinism/state_hash" "${images[@]}" >"$results/$name.txt" || status=1
  each replay "$results"/*.plr || status=1
done
"$root/tests/determinism/compare.sh" "$results"/gcc-O3.txt "$results"/gcc-O1.txt "$results"/clang-O1.txt "$results"/clang-O3.txt ||
  status=1
exit "$status"
