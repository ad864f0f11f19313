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
look bare.png 640 480 "$folder/run.plr" --at 2.5 --view top --no-panel
look scene.png 640 480 "$scene" --at 0.5
if "$palpate" view "$folder/nothing.plr" --screenshot "$folder/none.png" 2>"$folder/error"; then
  echo "a recording that is not there was shown"
  exit 1
fi
grep -q nothing.plr "$folder/error"
echo "passed"
