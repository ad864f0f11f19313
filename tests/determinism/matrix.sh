#!/usr/bin/env bash
# The bit-determinism promise, tested: several builds tick the same baked scenes and must print the same hashes; a recording
# made by the first must replay to the same bits in all of them. The release build is gcc -O3 on x86-64. `compilers`: gcc and
# clang, -O1 and -O3, here; `aarch64`: gcc -O1 and -O3 for AArch64, under qemu-user.
# Usage: matrix.sh compilers|aarch64 RELEASE_BUILD_DIR JOBS [NAME=BUILD_DIR...]
# The other builds are made beside the release build, but for those given: a sanitizer's build is one of -O1 and computes
# the same arithmetic, as in `matrix.sh compilers build/release 2 clang-O1=build/asan`.
# shellcheck disable=SC2317  # called through each()
set -euo pipefail
usage='usage: matrix.sh compilers|aarch64 RELEASE_BUILD_DIR JOBS [NAME=BUILD_DIR...]'
matrix=${1:?$usage} release=${2:?$usage} jobs=${3:?$usage}
shift 3
root=$(cd "$(dirname "$0")/../.." && pwd)
release=$(cd "$release" && pwd)
base=$(dirname "$release")
results=$release/determinism-$matrix
rm -rf "$results" && mkdir -p "$results"

declare -A builds=([gcc-O3]=$release)
names=(gcc-O3)
emulator=''
for given in "$@"; do
  builds[${given%%=*}]=$(cd "${given#*=}" && pwd)
done

build() { # NAME LEVEL CMAKE_OPTION...
  local name=$1 level=$2
  shift 2
  names+=("$name")
  [ -z "${builds[$name]:-}" ] || return 0
  builds[$name]=$base/determinism-$name
  ! command -v ccache >/dev/null || set -- "$@" -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
  cmake -S "$root" -B "${builds[$name]}" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="$level -DNDEBUG" "$@"
  cmake --build "${builds[$name]}" -j "$jobs" --target state_hash replay_bits
}
case $matrix in
  compilers)
    build gcc-O1 -O1 -DCMAKE_CXX_COMPILER=g++
    build clang-O1 -O1 -DCMAKE_CXX_COMPILER=clang++-22
    build clang-O3 -O3 -DCMAKE_CXX_COMPILER=clang++-22
    ;;
  aarch64)
    emulator=$root/tests/aarch64/emulator.sh
    for level in O3 O1; do
      build aarch64-$level -$level --toolchain "$root/tests/aarch64/toolchain.cmake" -DPALPATE_MESH=OFF -DPALPATE_VIEW=OFF
    done
    ;;
  *) echo "$usage" && exit 2 ;;
esac

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

# In virtual time, so that a busy machine makes no shorter recording.
record() { # IMAGE: three seconds of its scene, along its own path
  local scene
  scene=$(basename "$1" .pal)
  cp "$1" "$results/$scene.pal"
  "$release/laboratory/lab_scene" "$root/config/scenes/$scene.toml" "$results"
  "$release/bin/palpate" run "$results/$scene.pal" --path "$results/$scene.csv" --virtual-time --duration 3 --quiet \
    --record "$results/$scene.plr" || echo "the run of $scene ended with a fault; it must replay all the same"
}

run() { # PROGRAM ARGUMENT...: of the build `name`
  local program=${builds[$name]}/tests/determinism/$1
  shift
  case $name in aarch64-*) "$emulator" "$program" "$@" ;; *) "$program" "$@" ;; esac
}

hash_ticks() { # IMAGE: a file of its own, as lines of several programs would mix
  run state_hash "$1" >"$results/$name/$(basename "$1").txt"
}

replay() { # IMAGE: of the recording beside it
  local said scene
  scene=$(basename "$1" .pal)
  if said=$(run replay_bits "$results/$scene.plr" 2>&1); then
    echo "$name: $said"
  else
    echo "$name: $scene: $said"
    return 1
  fi
}

images=("$release"/scenes/*.pal)
tables=()
status=0
each record "${images[@]}"
for name in "${names[@]}"; do
  mkdir "$results/$name"
  each hash_ticks "${images[@]}" || status=1
  cat "$results/$name"/*.txt >"$results/$name.txt"
  tables+=("$results/$name.txt")
  each replay "${images[@]}" || status=1
done
"$root/tests/determinism/compare.sh" "${tables[@]}" || status=1
exit "$status"
