#!/usr/bin/env bash
# Gate on instruction counts, which are the same on every run: the worst tick of each scene against its budget, and the
# same ellipsoid meshed three ways; and a tick with sixty nodes that push and slip. `scene` plays the scripted hand,
# `paths` the scene's own path as `palpate run` and the laboratory do. Usage:
#   tick_instructions.sh scene PROGRAM IMAGE_DIR SCENE.toml
#   tick_instructions.sh paths PATH_PROGRAM IMAGE_DIR SCENE_DIR
#   tick_instructions.sh meshes PROGRAM PALPATE SCENE.toml
#   tick_instructions.sh nodal NODAL_PROGRAM
#   tick_instructions.sh overlays PROGRAM PALPATE SCENE_DIR
# Of the scripted hand's ticks in a scene the dearest and a sample are counted; all with PALPATE_COUNT_ALL=1.
set -euo pipefail
usage="usage: tick_instructions.sh scene PROGRAM IMAGE_DIR SCENE.toml | paths PROGRAM IMAGE_DIR SCENE_DIR |"
usage+=" meshes PROGRAM PALPATE SCENE.toml |"
usage+=" overlays PROGRAM PALPATE SCENE_DIR | nodal PROGRAM"
mode=${1:?$usage} program=${2:?$usage}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
command -v valgrind >/dev/null || { echo "valgrind is missing: apt-get install valgrind"; exit 1; }

# The functions of the stages, in order, from their one list.
stages=$(sed -nE 's/^ *X\(k[A-Za-z]+, ([a-z_]+), "[a-z]+", .*/\1/p' "$here/../../rt_core/status.h")

# The most instructions a scene's worst tick may take stand in the scene itself; a shipped scene without is an error.
budget_of() {
  local budget
  budget=$(sed -nE 's/^budget_instructions *= *([0-9]+).*/\1/p' "$1")
  [ "${budget:-0}" -gt 0 ] || { echo "$1: no budget_instructions: state what its worst tick may cost" >&2; exit 1; }
  echo "$budget"
}
# The scenes in which a path reaches states that the scripted hand does not: a tube seated in its clip, a block tugged at.
path_scenes='snap_in snap_in_paper pinch_block pinch_block_nodal'
# Every tool on the softest and the stiffest material in the two tool scenes, but for the layer of rubber, on which every
# tool takes 700 to 3,500 instructions less than on the layer of liver (seven of seven, 2026-11-25), and two thirds of a
# minute together. 21,166 that day: the account of energy costs about 1,200 of it, the smoothed encoder 1,000.
tools_budget=22000
# Largest ratio between the meshes: cost may grow with the hierarchy's depth only. 136 % for the worst tick and 102 % for
# the mean in contact, 2026-11-26: 25,497 instructions on 3,000 triangles, 33,604 on 30,000, 34,788 on a million; 27,467
# and 34,387 on the first two (125 %) before what does not depend on the mesh became cheaper. The goal is 130 %.
mesh_ratio_percent=140

# count ARGUMENTS: prints the stage table and sets worst, mean.
count() {
  valgrind --tool=callgrind --quiet --instr-atstart="$from_start" --collect-atstart=no --combine-dumps=yes --compress-strings=no \
    --compress-pos=no --callgrind-out-file="$work/counts" "$program" "$@" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
  awk -v functions="$stages" -f "$here/worst_tick.awk" "$work/counts" >"$work/table" || { cat "$work/table"; exit 1; }
  grep -v '^summary ' "$work/table"
  read -r _ worst mean ticks in_contact < <(grep '^summary ' "$work/table")
  [ "$in_contact" -gt $((ticks / least_contact)) ] || { echo "only $in_contact of $ticks ticks touch the body: this proves nothing"; exit 1; }
}

# What the image states of each stage holds for every tick just counted; an image that states nothing proves nothing.
within_bounds() {
  awk '$1 == "bound" { bound[$2] = $3; next }
    $1 in bound && $3 > bound[$1] { print "OVER THE IMAGE: " $1 " took " $3 ", it states " bound[$1]; bad = 1 }
    $1 in bound { seen++ }
    END { if (seen < 7) print "only " seen + 0 " stages have a bound"; exit bad || seen < 7 }' "$work/log" "$work/table"
}

# judge BUDGET: what was counted last against it, into status.
judge() {
  local verdict=ok
  if [ "$worst" -gt "$1" ]; then verdict="OVER BUDGET" status=1; fi
  echo "worst tick $worst of $1 instructions: $verdict"
}

status=0 least_contact=2 from_start=no all=${PALPATE_COUNT_ALL:+all}
if [ "$mode" = paths ]; then
  images=${3:?$usage} scenes=${4:?$usage} least_contact=3
  for scene in $path_scenes; do
    echo "== $scene, its own path"
    budget=$(budget_of "$scenes/$scene.toml")
    count "$images/$scene.pal" "$scenes/$scene.toml"
    judge "$budget"
  done
elif [ "$mode" = scene ]; then
  images=${3:?$usage} file=${4:?$usage}
  scene=$(basename "$file" .toml) budget=$(budget_of "$file")
  echo "== $scene"
  count "$images/$scene.pal" $all
  within_bounds || status=1
  judge "$budget"
elif [ "$mode" = meshes ]; then
  palpate=${3:?$usage} scene=${4:?$usage}
  grep -qE '^triangles *=' "$scene" || { echo "$scene has no key 'triangles' to vary"; exit 1; }
  least_worst=0 least_mean=0 most_worst=0 most_mean=0
  for triangles in 3000 30000 1000000; do
    sed -E "s/^triangles *=.*/triangles = $triangles/" "$scene" >"$work/scene.toml"
    "$palpate" bake "$work/scene.toml" -o "$work/scene.pal" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
    echo "== $triangles triangles"
    count "$work/scene.pal" $all
    [ "$least_worst" -ne 0 ] && [ "$least_worst" -le "$worst" ] || least_worst=$worst
    [ "$least_mean" -ne 0 ] && [ "$least_mean" -le "$mean" ] || least_mean=$mean
    [ "$most_worst" -ge "$worst" ] || most_worst=$worst
    [ "$most_mean" -ge "$mean" ] || most_mean=$mean
  done
  ratio_worst=$((100 * most_worst / least_worst)) ratio_mean=$((100 * most_mean / least_mean))
  [ "$ratio_worst" -le "$mesh_ratio_percent" ] && [ "$ratio_mean" -le "$mesh_ratio_percent" ] || status=1
  echo "largest over smallest: worst tick $ratio_worst %, mean in contact $ratio_mean % (at most $mesh_ratio_percent %)"
elif [ "$mode" = nodal ]; then
  from_start=yes
  # 305,732 on 2026-11-26, of which friction of 57 nodes that slip is 9,000 more than before the spring was asked once a
  # stretch: that made fingers cheaper, whose stretch is kept.
  for part in slide rock; do
    echo "== $part"
    count "$part"
    judge 310000
  done
elif [ "$mode" = overlays ]; then
  palpate=${3:?$usage} scenes=${4:?$usage}
  most=0
  for scene in tools_on_cylinder tools_on_layer; do
    for tool in "$scenes"/tools/*.toml; do
      for material in liver rubber; do
        [ "$scene $material" != "tools_on_layer rubber" ] || continue
        echo "== $scene, $(basename "$tool" .toml), $material"
        "$palpate" bake "$scenes/$scene.toml" --with "$tool" --with "$scenes/materials/$material.toml" \
          -o "$work/scene.pal" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
        count "$work/scene.pal" $all >"$work/stages"
        tail -n 1 "$work/stages"
        [ "$most" -ge "$worst" ] || most=$worst
      done
    done
  done
  [ "$most" -le "$tools_budget" ] || status=1
  echo "worst tick of all $most of $tools_budget instructions"
else
  echo "$usage"
  exit 2
fi
exit "$status"
