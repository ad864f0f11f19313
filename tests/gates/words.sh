#!/usr/bin/env bash
# Gate: words that do not belong. In rt_core: anything that allocates, locks, throws, prints, reads a clock or calls the
# C library's elementary functions (their bits differ between versions). Anywhere: marks of unfinished work, skipped
# tests, and paths of one person's machine. Usage: words.sh ROOT
set -euo pipefail
root=${1:?usage: words.sh ROOT}
. "$(dirname "$0")/files.sh"

core='\b(new|delete|malloc|calloc|realloc|free|alloca|throw|try|catch|goto|typeid|dynamic_cast|thread_local|volatile)\b'
core+='|\bstd::(vector|string|string_view|function|map|set|list|deque|mutex|thread|chrono|optional|unique_ptr|shared_ptr|sort)\b'
core+='|\bstd::(sin|cos|tan|asin|acos|atan|atan2|exp|log|pow|cbrt|hypot|fma|sqrt)\b|\b(printf|fprintf|puts|assert|abort|exit)\('
core+='|\bwhile *\((true|1)\)|\bfor *\(;;\)|MatrixX|VectorX|Eigen::Dynamic'
# A "= delete" declaration allocates nothing, nor does making an object where memory is.
allowed_core='= *delete;|::new \(static_cast<void\*>'
# Written with brackets so that this file does not contain what it looks for.
unfinished='\b(TO[D]O|FIX[M]E|X[X]X)\b|GTEST_S[K]IP|DISABLE[D]_'
machine='(^|[^A-Za-z0-9_.])/(wor[k]|roo[t]|hom[e])/|\.\./share[d]|/tm[p]/rt|paper[s]/[a-z]'

problems=0
report() { # TITLE LINES
  [ -n "$2" ] || return 0
  printf '%s\n%s\n' "$1" "$2"
  problems=$((problems + $(wc -l <<<"$2")))
}
search() { (cd "$root" && grep -InE "$1" "${all_files[@]}" || true); }
search_core() {
  list_files "$root" cpp h | { grep '^rt_core/' || true; } | while IFS= read -r file; do
    code_only "$root/$file" | grep -nE "$core" | grep -vE "$allowed_core" | sed "s|^|$file:|" || true
  done
}

mapfile -t all_files < <(list_files "$root" any)
[ "${#all_files[@]}" -gt 0 ] || { echo "no files found under $root"; exit 1; }
report "words that do not belong in a tick:" "$(search_core)"
report "marks of unfinished work or skipped tests:" "$(search "$unfinished")"
report "paths that only exist on one machine:" "$(search "$machine")"
[ "$problems" -eq 0 ] || { echo "words: $problems problems"; exit 1; }
echo "words: ${#all_files[@]} files, no problem"
