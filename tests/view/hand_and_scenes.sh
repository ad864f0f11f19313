#!/usr/bin/env bash
# On a screen that is not there: keys and sliders move single joints of a hand, and the run replays; a run goes over to another
# tool, another material and a given image, and what does not fit is refused with the reason. Leaves FOLDER/*.png, to be looked at.
# Usage: hand_and_scenes.sh PALPATE SCENES FOLDER
set -euo pipefail
palpate=$1 scenes=$2 pictures=$3
mkdir -p "$pictures"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

on_screen() { xvfb-run -a -s '-screen 0 1280x1024x24' "$palpate" view "$@" --size "${PALPATE_SESSION_SIZE:-1280x800}"; }
drawn() { # NAME...: pictures that are not blank, as in smoke.sh
  for name; do
    [ "$(stat -c %s "$pictures/$name.png")" -gt 20000 ] || { echo "$name.png is blank"; exit 1; }
  done
}
replays() {
  "$palpate" replay "$1" >"$folder/replay" || { echo "$1 does not replay"; cat "$folder/replay"; exit 1; }
  grep -q identical "$folder/replay"
}
refused() { # WORD SCENE STEP: a script of this step ends with WORD and exit code 2
  echo "$3" >"$folder/wrong.txt"
  # xvfb-run has exit codes of its own, when it cannot clean up.
  xvfb-run -a -s '-screen 0 1280x1024x24' bash -c 'code=0; "$@" || code=$?; echo $code >"$0"' "$folder/code" \
    "$palpate" view "$2" --script "$folder/wrong.txt" --size 640x480 >"$folder/error" 2>&1 || true
  [ "$(cat "$folder/code")" = 2 ] || { echo "exit code $(cat "$folder/code") of: $3"; cat "$folder/error"; exit 1; }
  grep -q -e "wrong.txt:1.*$1" "$folder/error" || { echo "without '$1':"; cat "$folder/error"; exit 1; }
}

# --- Single joints ---
hand=$scenes/grasp_cylinder_2.toml
cat >"$folder/joints.txt" <<END
wait 0.3
close 0.8 index_flexion     # keys F2, S and C
joint index_tip_flexion=30  # its slider
close 0.5 thumb             # keys F1 and C
wait 0.5
picture $pictures/joints.png
free index_tip_flexion
open 0.4 index_flexion
wait 0.5
END
on_screen "$hand" --script "$folder/joints.txt" --record "$folder/joints.plr"
drawn joints
replays "$folder/joints.plr"
"$palpate" replay "$folder/joints.plr" --dump "$folder/ticks.csv" >/dev/null
# Joints 6 and 8 of the hand's 21 are the index finger's first flexion and its tip's. Told at 60 pictures a second a joint moves on
# by 1.5 degrees at most between two looks (10 ms, or the 50 ms of a slow picture, at a quarter of 90 degrees a second).
python3 - "$folder/ticks.csv" <<'END'
import csv, math, sys
rows = list(csv.DictReader(open(sys.argv[1])))
direct = [int(float(row["joint_direct"])) for row in rows]
target = [math.degrees(float(row["joint_target_6"])) for row in rows]
first = next(i for i, d in enumerate(direct) if d)
assert direct[first] == 1 << 6, "the key's joint alone: %d" % direct[first]
assert 1 << 6 | 1 << 8 in direct, "then the slider's, too"
assert direct[-1] == 1 << 6, "the slider's joint is free again: %d" % direct[-1]
assert max(target[first:]) > target[first] + 10, "a quarter of its range in a second, 0.8 s"
steps = [abs(b - a) for a, b in zip(target[first:], target[first + 1:])]
assert max(steps) < 1.5, "%g degrees at once" % max(steps)
END
refused "no joint 'index_flexing'; joints are thumb_root_spread" "$hand" 'close 1 index_flexing'
refused "outside" "$hand" 'joint index_flexion=400'
refused "has no joints" "$scenes/tools_on_layer.toml" 'close 1'

# --- Other tools, materials, images ---
layer=$scenes/tools_on_layer.toml
"$palpate" bake "$layer" --with "$scenes/tools/flat_3_2.toml" --set name=given -o "$folder/given.pal" >/dev/null
"$palpate" bake "$layer" --set device.period_ms=2 -o "$folder/slow.pal" >/dev/null
cat >"$folder/scenes.txt" <<END
wait 0.2
drag -30 32 0 0.4
list
refused . laws/cui_xiao_2008
wait 0.1
picture $pictures/refused.png
refused . hands/clip_in_hand
refused $folder/slow.pal
list
switch . tools/cone_30
drag -30 40 0 0.3
wait 0.4
drag -30 25 0 0.6
wait 0.2
picture $pictures/cone.png
drag -30 40 0 0.3
switch . tools/cone_30 tissues/brain
wait 0.4
list
picture $pictures/brain.png
switch $folder/given.pal
END
on_screen "$layer" --also "$folder/given.pal" --script "$folder/scenes.txt" --record "$folder/run.plr" >"$folder/log"
drawn refused cone brain
for part in run run.scene-2 run.scene-3 run.scene-4; do
  replays "$folder/$part.plr"
  grep -q "record .*/$part.plr" "$folder/log" || { echo "$part.plr is not named"; cat "$folder/log"; exit 1; }
done
for words in 'scenes.txt:4: .*is refused: .*contact.duffing' 'is refused: .*held_part' 'is refused: .*period_s is 0.002' \
  'scenes.txt:10: tools_on_layer + cone_30 is there'; do
  grep -q -e "$words" "$folder/log" || { echo "without '$words':"; cat "$folder/log"; exit 1; }
done
refused 'is refused: .*contact.duffing' "$layer" 'switch . laws/cui_xiao_2008'
refused 'tools/cone_31: no such file' "$layer" 'switch . tools/cone_31'
refused 'is there' "$layer" 'refused . tools/cone_45'
echo "passed"
