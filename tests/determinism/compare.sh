#!/usr/bin/env bash
# Compares what state_hash printed in several builds. Usage: compare.sh FILE FILE...
# Prints a table; exits 1 unless every file has the same lines, and at least one.
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: compare.sh FILE FILE..."; exit 2; }
status=0
for file in "$@"; do
  while read -r scene ticks hash contact regions; do
    printf '%-18s %-24s %s  %s ticks, %s in contact, up to %s regions\n' \
      "$(basename "$file" .txt)" "$scene" "$hash" "$ticks" "$contact" "$regions"
  done <"$file"
  [ -s "$file" ] || { echo "$file is empty"; status=1; }
  cmp -s "$1" "$file" || { echo "$(basename "$file" .txt) differs from $(basename "$1" .txt)"; status=1; }
done
exit "$status"
