#!/usr/bin/env bash
# Gate: a source file is one noun, and one noun fits in 500 lines of at most 120 columns. Usage: file_size.sh ROOT
set -euo pipefail
root=${1:?usage: file_size.sh ROOT}
. "$(dirname "$0")/files.sh"
limit=500

# One wc for as many files as fit a command line: a process for each of 1,700 took 8 to 36 s.
sizes=$(list_files "$root" cpp h h.in sh cmake | (cd "$root" && tr '\n' '\0' | xargs -0r wc -l) | awk '!($2 == "total" && NF == 2)')
count=$(grep -c . <<<"$sizes" || true)
[ "$count" -gt 0 ] || { echo "no source files found under $root"; exit 1; }
awk -v limit="$limit" '$1 > limit { size = $1; sub(/^ *[0-9]+ /, ""); print $0 ": " size " lines; the limit is " limit ": split it by noun"; n++ }
  END { if (n) print "file size: " n " problems"; exit n > 0 }' <<<"$sizes"
echo "file size: $count files, no problem"
