#!/usr/bin/env bash
# Gate: the controller program takes from libccd only the overlap test (the penetration and separation routines allocate,
# the portal routines have loops without a cap) and links no parser, mesh reader or picture library.
# Usage: symbols_controller.sh PROGRAM
set -euo pipefail
program=${1:?usage: symbols_controller.sh PROGRAM}

problems=0
report() {
  echo "$1"
  problems=$((problems + 1))
}
# Dynamic imports, and for a static libccd the names inside the program.
while IFS= read -r symbol; do
  case $symbol in
    ccdGJKIntersect | ccdFirstDirDefault | ccd_vec3_origin | _ccd_vec3_origin) ;;
    *) report "$program uses $symbol of libccd; only ccdGJKIntersect is bounded and allocates nothing" ;;
  esac
done < <({ nm -D --undefined-only --format=posix "$program"; nm --format=posix "$program" 2>/dev/null || true; } |
  awk '{sub(/@.*/, "", $1); print $1}' | grep -E '^_?ccd' | LC_ALL=C sort -u || true)
needed=$(LC_ALL=C readelf -d "$program" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
[ -n "$needed" ] || report "$program: cannot read its list of libraries"
while IFS= read -r library; do
  case $library in
    libccd.so.* | libstdc++.so.* | libm.so.* | libc.so.* | libgcc_s.so.* | ld-linux-x86-64.so.* | "") ;;
    *) report "$program links $library; the controller holds only what has deadlines" ;;
  esac
done <<<"$needed"
[ "$problems" -eq 0 ] || exit 1
echo "controller symbols: links" $needed
