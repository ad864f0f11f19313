#!/usr/bin/env bash
# A run is recorded and looked at on a screen that is not there: smoke.sh PALPATE SCENE.toml
set -euo pipefail
palpate=$1 scene=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

look() { # FILE WIDTH HEIGHT [OPTION...]: a picture of that size that is not blank
  local file=$folder/$1 width=$2 height=$3 size
  shift 3
  xvfb-run -a -s '-screen 0 1280x1024x24' "$palpate" view "$@" --screenshot "$file" --size "${width}x$height"
  size=$(od -An -tu1 -j16 -N8 "$file" | awk '{ print ($1*256+$2)*65536+$3*256+$4, ($5*256+$6)*65536+$7*256+$8 }')
  [ "$size" = "$width $height" ] || { echo "$file: $size pixels instead of $width $height"; exit 1; }
  # A blank picture of this size packs into some 3 kB; one with body, plots and text takes 50 and more.
  [ "$(stat -c %s "$file")" -gt 20000 ] || { echo "$file: only $(stat -c %s "$file") bytes: is it blank?"; exit 1; }
}

"$palpate" run "$scene" --virtual-time --duration 3 --image "$folder/scene.pal" --record "$folder/run.plr" --quiet --no-black-box >/dev/null
look whole.png 800 500 "$folder/run.plr"
look bare.png 640 480 "$folder/run.plr" --at 2.5s --view top --no-panel
# To programs it is one object, and nothing else.
look told.png 400 300 "$folder/run.plr" --json >"$folder/told.json"
! command -v python3 >/dev/null || python3 -c 'import json, sys; told = json.load(sys.stdin); sys.exit(told["command"] != "view" or len(told["files"]) != 1)' <"$folder/told.json"
look pressure.png 640 480 "$folder/run.plr" --colour pressure
! cmp -s "$folder/pressure.png" "$folder/bare.png" || { echo "pressure is drawn as displacement"; exit 1; }
look stress.png 640 480 "$folder/run.plr" --colour stress
look scene.png 640 480 "$scene" --at 0.5
look laid.png 640 480 "$scene" --set name=laid --at 0.5
look both.png 800 500 "$folder/run.plr" "$folder/run.plr" --align touch
# A script: the mouse drags the tool, a setting changes, the run is recorded; pictures where it says so.
printf '%s\n' 'wait 0.3' 'drag 0 60 0 0.5' 'set stiffness=0.5' 'colour pressure' 'wait 0.3' "picture $folder/dragged.png" release \
  'scrub 0.2' "picture $folder/scrubbed.png" >"$folder/session.txt"
xvfb-run -a -s '-screen 0 1280x1024x24' "$palpate" view "$scene" --script "$folder/session.txt" --size 640x480 \
  --record "$folder/session.plr" >"$folder/log"
for picture in dragged scrubbed; do
  [ "$(stat -c %s "$folder/$picture.png")" -gt 20000 ] || { echo "$picture.png is blank"; exit 1; }
done
"$palpate" replay "$folder/session.plr" | grep -q identical
look other.png 640 480 "$folder/run.plr" "$folder/session.plr"
# The vertex shader's surface is that of pictures and exports: in single precision some 0.01 um and 0.002 degrees apart
# (2026-11-25, five elastic scenes; a million triangles as well). What moves has coarser normals.
xvfb-run -a -s '-screen 0 1280x1024x24' "$palpate" view "$folder/run.plr" --stats --triangles 250000 --size 640x480 >"$folder/stats"
awk '/^shader  in full/ { full = $9 < 0.1 && $12 < 0.02 && $15 < 0.1 } /^shader  moving/ { moving = $8 < 0.1 && $11 < 10 } END { exit !(full && moving) }' \
  "$folder/stats" || { cat "$folder/stats"; echo "the vertex shader's surface is another one"; exit 1; }

refused() { # WORD ARGUMENT...: `palpate view` says WORD and shows nothing
  local word=$1
  shift
  if xvfb-run -a "$palpate" view "$@" --screenshot "$folder/none.png" 2>"$folder/error"; then
    echo "was shown: $*"
    exit 1
  fi
  grep -q -e "$word" "$folder/error" || { echo "without '$word':"; cat "$folder/error"; exit 1; }
}
echo garbage >"$folder/garbage.plr"
refused '--set' "$folder/run.plr" --set name=laid
refused garbage.plr "$folder/run.plr" "$folder/garbage.plr"
refused 'record it first' "$folder/run.plr" "$scene"
refused 'script' "$folder/run.plr" --script "$folder/session.txt"
if "$palpate" view "$folder/nothing.plr" --screenshot "$folder/none.png" 2>"$folder/error"; then
  echo "a recording that is not there was shown"
  exit 1
fi
grep -q nothing.plr "$folder/error"
echo "passed"
