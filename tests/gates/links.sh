#!/usr/bin/env bash
# Gate: a document that is named exists. Checks every docs/*.md path in any file, and relative links in Markdown files.
# Usage: links.sh ROOT
set -euo pipefail
root=${1:?usage: links.sh ROOT}
. "$(dirname "$0")/files.sh"

problems=0
report() {
  echo "$1"
  problems=$((problems + 1))
}
mapfile -t files < <(list_files "$root" any)
[ "${#files[@]}" -gt 0 ] || { echo "no files found under $root"; exit 1; }
while IFS=: read -r file line target; do
  [ -f "$root/$target" ] || report "$file:$line: names $target, which does not exist"
done < <(cd "$root" && grep -InoE '\bdocs/[A-Za-z0-9_/-]+\.md\b' "${files[@]}" | grep -v '^tests/gates/' || true)
while IFS=: read -r file line link; do
  target=${link#](}
  target=${target%%[)#]*}
  case $target in '' | *://* | mailto:*) continue ;; esac
  [ -e "$root/$(dirname "$file")/$target" ] || report "$file:$line: links to $target, which does not exist"
done < <(cd "$root" && printf '%s\n' "${files[@]}" | { grep '\.md$' || true; } | xargs -r grep -InoE '\]\([^)]+\)' /dev/null || true)
[ "$problems" -eq 0 ] || { echo "links: $problems problems"; exit 1; }
echo "links: ${#files[@]} files, no problem"
