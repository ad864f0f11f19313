#!/usr/bin/env bash
# Gate on the dearest tick that `palpate certify` finds in every shipped scene, its own path included: no tick takes
# more than the image states, and none more than the scene's line in certified.txt. The same seed finds the same.
# Usage: certified.sh PALPATE IMAGE_DIR SCENE_DIR [TICKS]
set -euo pipefail
usage="usage: certified.sh PALPATE IMAGE_DIR SCENE_DIR [TICKS]"
palpate=${1:?$usage} images=${2:?$usage} scenes=${3:?$usage} ticks=${4:-20000}
limits=$(cd "$(dirname "$0")" && pwd)/certified.txt
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

status=0
for image in "$images"/*.pal; do
  name=$(basename "$image" .pal)
  "$palpate" certify "$image" --along "$scenes/$name.toml" --ticks "$ticks" -o "$work/$name.pal" >"$work/log" ||
    { cat "$work/log"; status=1; }
  # Lines: tick FOUND STATED instructions...; found by WHO, in N ticks
  found=$(awk '$1 == "tick" { print $2 }' "$work/log") stated=$(awk '$1 == "tick" { print $3 }' "$work/log")
  by=$(sed -n 's/^found by *\(.*\), in .*/\1/p' "$work/log")
  limit=$(awk -v name="$name" '$1 == name { print $2 }' "$limits")
  printf '%-26s %8d of %8d instructions stated, limit %8d, found by %s\n' "$name" "${found:-0}" "${stated:-0}" \
    "${limit:-0}" "$by"
  [ "${found:-0}" -gt 0 ] || { echo "$name: certify told no tick"; status=1; }
  [ -n "$limit" ] || { echo "$name: no line in certified.txt: state what its dearest tick may take"; status=1; limit=$found; }
  [ "${found:-0}" -le "$limit" ] || { echo "$name: $found instructions, above $limit of certified.txt"; status=1; }
done
while read -r name limit _; do
  [[ $name == '#'* ]] || [ -e "$images/$name.pal" ] || { echo "certified.txt: no scene $name"; status=1; }
done <"$limits"
exit "$status"
