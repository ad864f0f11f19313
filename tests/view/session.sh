#!/usr/bin/env bash
# A person's session with shipped scenes on a screen that is not there: the mouse drags the tool along the scene's own way and
# presses, fingers close, a live setting changes, the run is scrubbed, replayed, and compared with the scene's own motion. Leaves
# FOLDER/SCENE_{press,set,scrub,compare}.png, to be looked at. Usage: session.sh PALPATE FOLDER SCENE.toml...
set -euo pipefail
palpate=$1 folder=$2
shift 2
size=${PALPATE_SESSION_SIZE:-1280x800}
mkdir -p "$folder"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

on_screen() { xvfb-run -a -s '-screen 0 1920x1200x24' "$palpate" view "$@" --size "$size" >>"$work/log"; }

# The places of the scene's motion, one a line, "X Y Z", each once.
places() { sed -n '/^\[path\]/,$ s/.*position_mm = \[\([^]]*\)\].*/\1/p' "$1" | tr -d ',' | uniq; }

session() { # SCENE.toml: what the person does
  local name=$2 place seconds=0.8
  mapfile -t place < <(places "$1" | sed -n '2,4p')
  echo "wait 0.4"
  echo "drag ${place[0]} $seconds"
  if grep -q 'closing = \[' "$1"; then
    echo "wait 0.3"
    echo "close 3.2"
  else
    echo "drag ${place[1]} $seconds"
  fi
  printf '%s\n' "wait 0.5" "fit" "picture $folder/${name}_press.png" "set stiffness=0.5" "set friction=0.5"
  [ -z "${place[2]:-}" ] || grep -q 'closing = \[' "$1" || echo "drag ${place[2]} $seconds"
  printf '%s\n' "wait 0.8" release fit "turn 25 6" "picture $folder/${name}_set.png" "scrub 1.9" "wait 0.2" "look front" "picture $folder/${name}_scrub.png"
}

for scene; do
  name=$(basename "$scene" .toml)
  : >"$work/log"
  session "$scene" "$name" >"$work/script"
  on_screen "$scene" --script "$work/script" --record "$work/session.plr" || { cat "$work/log"; exit 1; }
  "$palpate" replay "$work/session.plr" >>"$work/log" || { echo "$name: the session does not replay"; exit 1; }
  "$palpate" run "$scene" --virtual-time --duration 7 --image "$work/scene.pal" --record "$work/own.plr" --quiet --no-black-box \
    >>"$work/log" 2>&1 || echo "$name: the run of its own motion ended with $?"
  on_screen "$work/session.plr" "$work/own.plr" --align touch --screenshot "$folder/${name}_compare.png" || { cat "$work/log"; exit 1; }
  for picture in press set scrub compare; do
    # As in smoke.sh: a blank picture is much smaller.
    [ "$(stat -c %s "$folder/${name}_$picture.png")" -gt 20000 ] || { echo "${name}_$picture.png is blank"; exit 1; }
  done
  rm -f "$work"/*.plr "$work"/*.pal
  echo "session $name"
done
echo "passed"
