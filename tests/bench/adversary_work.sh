#!/usr/bin/env bash
# Gate on what a tick takes and counts of itself: the adversary's dearest ticks in every scene, counted by callgrind, take
# no more than certified.txt allows, nor in any stage more than the work they counted costs by the prices of
# rt_core/work.h; and the prices are not far too high.
# The ring with one and two soft modes is looked at as well, which a baker may choose: the shipped elastic bodies under
# balls have three and more.
# Usage: adversary_work.sh PROGRAM IMAGE_DIR PALPATE SCENES [TICKS COUNTED SEED]
set -euo pipefail
usage="usage: adversary_work.sh PROGRAM IMAGE_DIR PALPATE SCENES [TICKS COUNTED SEED]"
program=${1:?$usage} images=${2:?$usage} palpate=${3:?$usage} toml=${4:?$usage} ticks=${5:-20000} counted=${6:-60} seed=${7:-1}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
command -v valgrind >/dev/null || { echo "valgrind is missing: apt-get install valgrind"; exit 1; }
# The dearest tick of a scene by its prices over the same counted: above this they are too high to mean anything.
most_percent=185

mkdir "$work/few"
for modes in 1 2; do
  "$palpate" bake "$toml/ring.toml" --set "body.elastic.soft_modes=$modes" -o "$work/few/ring_of_${modes}_modes.pal" >"$work/log" 2>&1 ||
    { cat "$work/log"; exit 1; }
done

status=0 scenes=0
for image in "$images"/*.pal "$work"/few/*.pal; do
  scenes=$((scenes + 1))
  valgrind --tool=callgrind --quiet --instr-atstart=no --collect-atstart=no --combine-dumps=yes --compress-strings=no --compress-pos=no \
    --callgrind-out-file="$work/counts" "$program" "$image" "$ticks" "$counted" "$seed" >"$work/log" 2>&1 ||
    { cat "$work/log"; exit 1; }
  stages=$(awk '$1 == "bound" { print $2 }' "$work/log" | tr '\n' ' ')
  awk -v each=1 -v functions="$stages" -f "$here/worst_tick.awk" "$work/counts" >"$work/table" || { cat "$work/table"; exit 1; }
  awk -v scene="$(basename "$image" .pal)" -v most="$most_percent" -v file="$here/certified.txt" '
    BEGIN { while ((getline line < file) > 0) if (line !~ /^#/) { split(line, field); limits[field[1]] = field[3] } }
    $1 == "each" { took[$2, $3] = $4; next }
    $1 == "work" {
      whole = 0
      for (i = 3; $i != "units"; i += 2) {
        whole += $(i + 1)
        real = took[$2, $i]
        if (real > dearest[$i]) dearest[$i] = real
        if ($(i + 1) > priced[$i]) priced[$i] = $(i + 1)
        if (real > $(i + 1)) { printf "%s, tick %d: %s took %d, its work costs %d\n", scene, $2, $i, real, $(i + 1); bad = 1 }
      }
      ticks++
      if (whole > most_whole) most_whole = whole
      counted = 0
      for (i = 3; $i != "units"; i += 2) counted += took[$2, $i]
      if (counted > most_counted) most_counted = counted
    }
    END {
      if (ticks < 10 || most_counted == 0) { print scene ": only " ticks + 0 " ticks were counted"; exit 1 }
      ratio = 100 * most_whole / most_counted
      printf "%-24s %3d ticks counted, dearest %8d instructions, by its work %8d (%d %%); rows %d, solve %d, account %d\n",
        scene, ticks, most_counted, most_whole, ratio, dearest["find_rows"], dearest["solve"], dearest["account"]
      limit = limits[scene]
      if (limit == "" && scene !~ /_modes$/) { print scene ": no line in certified.txt: state what its dearest tick may take"; bad = 1 }
      if (limit != "" && most_counted > limit) { print scene ": " most_counted " instructions, above " limit " of certified.txt"; bad = 1 }
      if (ratio > most) { print scene ": the prices of rt_core/work.h are too high"; bad = 1 }
      exit bad
    }' "$work/table" "$work/log" || status=1
done
[ "$scenes" -ge 10 ] || { echo "only $scenes images in $images"; exit 1; }
exit "$status"
