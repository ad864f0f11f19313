#!/usr/bin/env bash
# Gate: the real-time core's archive may call nothing but itself and this list. An allocation, a lock, an exception, a
# print, a clock or the allocating half of libccd would show here as an imported name. Usage: symbols_core.sh ARCHIVE
set -euo pipefail
archive=${1:?usage: symbols_core.sh ARCHIVE}

# Memory functions (bounded by their length, no side effects); libccd's one bounded, allocation-free routine, its default first direction and its
# constant zero vector; what position-independent code and the stack protector need.
allowed='^(memcpy|memmove|memset|memcmp|memchr|bcmp|ccdGJKIntersect|ccdFirstDirDefault|ccd_vec3_origin|_ccd_vec3_origin'
allowed+='|_GLOBAL_OFFSET_TABLE_|__stack_chk_fail|_GLOBAL__.*)$'

defined=$(nm --defined-only --format=posix "$archive" | awk 'NF >= 2 && $2 ~ /[A-Za-z]/ {print $1}' | LC_ALL=C sort -u)
imported=$(nm --undefined-only --format=posix "$archive" | awk '$2 == "U" || $2 == "w" {print $1}' | LC_ALL=C sort -u)
[ -n "$defined" ] || { echo "$archive defines nothing"; exit 1; }
foreign=$(LC_ALL=C comm -23 <(echo "$imported") <(echo "$defined") | grep -vE "$allowed" | grep -v '^$' || true)
if [ -n "$foreign" ]; then
  echo "the real-time core imports names that are not on its list:"
  while IFS= read -r symbol; do
    # Which object needs it: nm prints "archive[object]:" before each object's names.
    user=$(nm --undefined-only --format=posix "$archive" | awk -v s="$symbol" '/:$/ {o = $0} $1 == s {print o; exit}')
    echo "  $(c++filt "$symbol")  needed by ${user:-?}"
  done <<<"$foreign"
  exit 1
fi
echo "core symbols: $(wc -l <<<"$defined") defined, nothing foreign imported"
