#!/usr/bin/env bash
# Gate: every C++ source is formatted by clang-format 14 with the repository's .clang-format. Usage: format.sh ROOT
set -euo pipefail
root=${1:?usage: format.sh ROOT}
. "$(dirname "$0")/files.sh"
# Debian 12 has this version, others have others, which format otherwise: not judged there (77: skipped).
command -v clang-format-14 >/dev/null || { echo "format: not judged, clang-format-14 is missing"; exit 77; }

mapfile -t files < <(list_files "$root" cpp h)
[ "${#files[@]}" -gt 0 ] || { echo "no source files found under $root"; exit 1; }
if ! messages=$(cd "$root" && clang-format-14 --dry-run -Werror "${files[@]}" 2>&1); then
  grep -E 'error:' <<<"$messages" | cut -d: -f1 | LC_ALL=C sort | uniq -c || echo "$messages"
  echo "format: the files above differ (number of places before each); run: clang-format-14 -i FILE"
  exit 1
fi
echo "format: ${#files[@]} files, no problem"
