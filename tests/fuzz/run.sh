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
cmake --preset fuzz >/dev/null && cmake --build build/fuzz --target "${targets[@]}" || exit 2
findings=$root/build/fuzz/findings
mkdir -p "$findings"
status=0
for name in "$@"; do
  work=$(mktemp -d)
  log=$work/log
  # 20 seconds over one input is a hang; 2 GiB is a leak.
  "$root/build/fuzz/tests/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -verbosity=1 \
    -artifact_prefix="$findings/$name-" -print_final_stats=1 "$work" "$here/corpus/$name" >"$log" 2>&1
  code=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
  if [ $code -eq 0 ]; then
    echo "$name: nothing found in ${runs:-?} runs, $seconds s, ${edges:-?} edges"
  else
    status=1
    echo "$name: FOUND something (exit $code):"
    grep -E 'ERROR|SUMMARY|runtime error|abort' "$log" | head -n 5
    cp "$log" "$findings/$name.log"
  fi
  rm -r "$work"
done
exit $status
