#!/usr/bin/env bash
# Gate: a source file is one noun, and one noun fits in 500 lines of at most 120 columns. Usage: file_size.sh ROOT
set -euo pipefail
root=${1:?usage: file_size.sh ROOT}
. "$(dirname "$0")/files.sh"
limit=500

problems=0
count=0
while IFS= read -r file; do
  count=$((count + 1))
  lines=$(wc -l <"$root/$file")
  if [ "$lines" -gt "$limit" ]; then
    echo "$file: $lines lines; the limit is $limit: split it by noun"
    problems=$((problems + 1))
  fi
done < <(list_files "$root" cpp h h.in sh cmake)
[ "$count" -gt 0 ] || { echo "no source files found under $root"; exit 1; }
[ "$problems" -eq 0 ] || { echo "file size: $problems problems"; exit 1; }
echo "file size: $count files, no problem"
