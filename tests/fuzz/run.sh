#!/usr/bin/env bash
# Fuzzes each target for so many seconds, starting from its kept corpus. A finding is left in build/fuzz/findings.
# Usage: tests/fuzz/run.sh SECONDS [TARGET...]
# Exit status: 0 nothing found, 1 something found, 2 bad arguments or the build failed.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
seconds=${1:-}
[[ $seconds =~ ^[0-9]+$ ]] || { sed -n '2,4s/^# //p' "$0" >&2; exit 2; }
shift
cd "$root" || exit 2
[ $# -gt 0 ] || set -- $(sed -n 's/^palpate_fuzzer(\([a-z_]*\) .*/\1/p' "$here/CMakeLists.txt")
targets=()
for name in "$@"; do
  [ -f "$here/fuzz_$name.cpp" ] || { echo "no target '$name'" >&2; exit 2; }
  targets+=("fuzz_$name")
done
jobs=${PALPATE_JOBS:-$(nproc)}
cmake --preset fuzz >/dev/null && cmake --build build/fuzz -j "$jobs" --target "${targets[@]}" || exit 2
findings=$root/build/fuzz/findings
mkdir -p "$findings"
said=$(mktemp -d)
trap 'rm -rf "$said"' EXIT

fuzz() { # NAME: says what came of it; fails if something was found
  local name=$1 work=$said/$1.work log=$said/$1.log code runs edges
  mkdir "$work"
  # 20 seconds over one input is a hang; 2 GiB is a leak.
  "$root/build/fuzz/tests/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -verbosity=1 \
    -artifact_prefix="$findings/$name-" -print_final_stats=1 "$work" "$here/corpus/$name" >"$log" 2>&1
  code=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
  if [ $code -eq 0 ]; then
    echo "$name: nothing found in ${runs:-?} runs, $seconds s, ${edges:-?} edges"
  else
    echo "$name: FOUND something (exit $code):"
    grep -E 'ERROR|SUMMARY|runtime error|abort' "$log" | head -n 5
    cp "$log" "$findings/$name.log"
    return 1
  fi
}

# As many at a time as there are processors; what they say comes in order.
status=0
pids=()
for name in "$@"; do
  [ "${#pids[@]}" -lt "$jobs" ] || { wait "${pids[0]}" || status=1; pids=("${pids[@]:1}"); }
  fuzz "$name" >"$said/$name" &
  pids+=($!)
done
for pid in "${pids[@]}"; do wait "$pid" || status=1; done
for name in "$@"; do cat "$said/$name"; done
exit $status
