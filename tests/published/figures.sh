#!/usr/bin/env bash
# The figures of the five papers from the shipped scenes: pictures, curves, contact sheets and numbers.csv, into a
# folder. Exits with 1 when a trend that a paper states does not come out, or when docs/papers.md does not state a
# number of numbers.csv as it comes out.
# Usage: figures.sh PALPATE FOLDER [PAPER_SHEETS]
set -euo pipefail
usage="usage: figures.sh PALPATE FOLDER [PAPER_SHEETS]"
palpate=$(realpath "${1:?$usage}") out=${2:?$usage} sheets=${3:+$(realpath "$3")}
root=$(cd "$(dirname "$0")/../.." && pwd)
mkdir -p "$out"
out=$(realpath "$out")
cd "$root/config/scenes"
status=0
log=$out/log.txt
: >"$log"
press() {
  local scene=$1
  shift
  "$palpate" press "$scene.toml" "$@" >>"$log" 2>&1 || { echo "press $scene failed, see $log"; exit 1; }
}
# claim TEXT CONDITION: CONDITION is an awk expression over numbers.
claim() {
  if awk "BEGIN { exit !($2) }"; then printf 'ok      %s\n' "$1"; else printf 'FAILED  %s (%s)\n' "$1" "$2"; status=1; fi
}
# stated ROW FORMAT VALUE...: docs/papers.md states the values in that row of its tables, the one that begins with ROW.
echo "row,values,as stated" >"$out/numbers.csv"
stated() {
  local row=$1 format=$2 text
  shift 2
  # shellcheck disable=SC2059  # the format is ours
  text=$(printf "$format" "$@")
  printf '"%s","%s","%s"\n' "$row" "$*" "$text" >>"$out/numbers.csv"
  if grep -F -- "| $row" "$root/docs/papers.md" | grep -qF -- "$text"; then
    printf 'stated  %s: %s\n' "$row" "$text"
  else
    printf 'FAILED  docs/papers.md does not say "%s" in the row "%s" (%s)\n' "$text" "$row" "$*"
    status=1
  fi
}
# column FILE NAME: its values, one a line.
column() { awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) c = i; next } { print $c + 0 }' "$1"; }
largest() { column "$1" "$2" | sort -g | tail -1; }

echo "== Luo & Xiao 2006"
press ellipsoid_mallet_paper --out "$out/2006_fig10.csv" --plot "$out/2006_fig10.svg" --png "$out/2006_fig10.png"
force=$(largest "$out/2006_fig10.csv" f_N)
slips=$(grep -c ',slip,' "$out/2006_fig10.csv")
claim "Fig. 10: the force reaches ${force} N (axis to 25)" "$force > 24 && $force < 26"
claim "Fig. 10: the mallet slides compliantly, in $slips ticks" "$slips > 1000"
step=$(awk -F, 'NR > 2 { d = sqrt(($10 - x) ^ 2 + ($11 - y) ^ 2 + ($12 - z) ^ 2); if (d > most) most = d } { x = $10; y = $11; z = $12 } END { print most }' "$out/2006_fig10.csv")
stated "Fig. 10: mallet slides" "%.2f N, %s ticks of slip, no tick above %.3f N of change" "$force" "${slips%???},${slips: -3}" "$step"
press heart_compass_paper --out "$out/2006_fig12.csv" --png "$out/2006_fig12.png"
regions=$(largest "$out/2006_fig12.csv" regions)
claim "Fig. 12: one, then $regions contact regions on the heart" "$regions == 2"
press heart_compass_paper --with laws/luo_xiao_2006.toml --out "$out/2006_fig12_printed.csv"
a=$(largest "$out/2006_fig12.csv" f_N) b=$(largest "$out/2006_fig12_printed.csv" f_N) c=$(largest "$out/2006_fig12_printed.csv" regions)
claim "Fig. 12, every law as printed: $c contact regions, up to $b N" "$c == 2 && $b >= $a"
stated "Fig. 12: compass" "two regions, %.2f N; all as printed two regions, %.2f N" "$a" "$b"

echo "== circular beams 2009"
press half_shell_paper --path "$root/docs/pictures/half_shell_press.csv" --resample --out "$out/2009_fig7.csv" \
  --png "$out/2009_fig7.png" --anchors "$out/2009_fig8.csv" --anchor-plot "$out/2009_fig8.png" --plotted-anchors 1,2,3,4,5
outer=""
for a in 1 2 3 4 5; do outer+=" $(largest "$out/2009_fig8.csv" a${a}_F_N)"; done
read -r f1 f2 f3 f4 f5 <<<"$(tr ' ' '\n' <<<"$outer" | sort -gr | tr '\n' ' ')"
claim "Fig. 8: nearer anchors carry more: $f1 $f2 $f3 $f4 $f5 N" "$f1 > $f2 && $f2 > $f3 && $f3 >= $f4 && $f4 > $f5 && $f5 > 0"
stated "Fig. 8, forces at the five" "%.3f, %.3f, %.3f, %.3f, %.3f N" "$f1" "$f2" "$f3" "$f4" "$f5"
inner=$(for a in 6 7 8 9 10; do largest "$out/2009_fig8.csv" a${a}_F_N; done | sort -gr | tr '\n' ' ')
read -r f1 f2 f3 f4 f5 <<<"$inner"
claim "Fig. 8: so do the inner ones: ${inner}N" "$f1 > $f2 && $f2 > $f3 && $f3 >= $f4 && $f4 > $f5 && $f5 > 0"
stated "inner anchors carry" "%.2f, %.2f, %.3f, %.3f, %.3f N" "$f1" "$f2" "$f3" "$f4" "$f5"
press half_shell_paper --with laws/circular_beams_2009.toml --path "$root/docs/pictures/half_shell_press.csv" --resample \
  --out "$out/2009_fig8_printed.csv" --anchors "$out/2009_fig8_printed_anchors.csv"
for rim in "outer 1 2 3 4 5" "inner 6 7 8 9 10"; do
  forces=$(for a in ${rim#* }; do largest "$out/2009_fig8_printed_anchors.csv" a${a}_F_N; done | sort -gr | tr '\n' ' ')
  read -r f1 f2 f3 f4 f5 <<<"$forces"
  claim "Fig. 8 by the printed sharing, ${rim%% *}: ${forces}N" "$f1 > $f2 && $f2 > $f3 && $f3 >= $f4 && $f4 > $f5 && $f5 > 0"
  [ "${rim%% *}" = inner ] || stated "Fig. 8, forces at the five" "printed sharing %.1f, %.2f, %.3f, %.3f, %.3f N of a contact of %.2f N" \
    "$f1" "$f2" "$f3" "$f4" "$f5" "$(largest "$out/2009_fig8_printed.csv" f_N)"
done
press ring_paper --with laws/circular_beams_2009.toml --out "$out/2009_fig9.csv" --png "$out/2009_fig9.png"
press grasp_cylinder_5 --with bodies/hollow_cylinder.toml --out "$out/2009_fig10.csv" --png "$out/2009_fig10.png"
"$palpate" grasp grasp_cylinder_2.toml grasp_cylinder_3.toml grasp_cylinder_5.toml --with bodies/hollow_cylinder.toml \
  --out "$out/2009_fig10" >"$out/2009_fig10.txt" 2>>"$log"
regions=$(awk '/regions/ { printf "%d ", $2 }' "$out/2009_fig10.txt")
stable=$(grep -c '^  stable:' "$out/2009_fig10.txt" || true)
claim "Fig. 10: different grasps hold the hollow cylinder, $stable, by ${regions}regions" \
  "$stable == 3 && \"$regions\" == \"6 9 15 \""
read -r a b c <<<"$regions"
stated "Fig. 10, different grasps" "%d, %d, %d regions" "$a" "$b" "$c"

echo "== Mahvash & Hayward 2002"
awk 'BEGIN { print "time_s,x_mm,y_mm,z_mm"; for (i = 0; i <= 6000; i++) printf "%g,0,%g,0\n", i / 1000, 220 - i / 1000 }' >"$out/2002_press_path.csv"
for kind in global local; do
  give=()
  [ "$kind" = local ] || give=(--with responses/global_give.toml)
  for tool in sphere_12_7 flat_3_2 sphere_3_2; do
    press tools_on_cylinder --with "tools/$tool.toml" "${give[@]}" --path "$out/2002_press_path.csv" --out "$out/2002_${kind}_$tool.csv"
  done
done
at() { awk -F, -v row=$(($2 + 2)) -v name=f_N 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) c = i } NR == row { print $c + 0 }' "$out/2002_$1.csv"; }
a=$(at global_sphere_12_7 6000) b=$(at global_flat_3_2 6000) c=$(at global_sphere_3_2 6000)
claim "Fig. 5: the body gives as a whole: at 6 mm $a, $b, $c N whatever the tool" "$b / $c < 1.06 && $a < $b && $a > $c"
stated "Figs. 4c, 5" "%.2f, %.2f, %.2f N at 6 mm" "$a" "$b" "$c"
awk 'BEGIN { print "time_s,x_mm,y_mm,z_mm"; for (i = 0; i <= 8000; i++) printf "%g,0,%g,0\n", i / 1000, 220 - (i < 4000 ? i : 8000 - i) / 1000 }' >"$out/2002_loop_path.csv"
press tools_on_cylinder --with tools/sphere_12_7.toml --with responses/global_give.toml --set body.material.lost_share=0.03 \
  --path "$out/2002_loop_path.csv" --out "$out/2002_fig5_loop.csv"
a=$(at fig5_loop 2000) b=$(at fig5_loop 6000)
claim "Fig. 5: a little less on the way back: $a and $b N at 2 mm" "$b < $a && $b > 0.9 * $a"
stated "Fig. 5: a small loss" "%.2f N on the way in, %.2f N back at 2 mm" "$a" "$b"
a=$(at local_sphere_12_7 1500) b=$(at local_flat_3_2 1500) c=$(at local_sphere_3_2 1500)
claim "Fig. 6: it is held: at 1.5 mm $a, $b, $c N" "$a > 1.2 * $b && $b > 1.5 * $c"
stated "Fig. 6: localised" "%.1f, %.1f, %.1f N at 1.5 mm" "$a" "$b" "$c"
# Table 1 with their E*, where they found it to fit: below 12 N. The body is a cylinder of 100 mm, not a half space.
for tool in sphere_12_7 sphere_3_2; do
  press tools_on_cylinder --with "tools/$tool.toml" --path "$out/2002_press_path.csv" \
    --out "$out/2002_table1_$tool.csv"
done
off=$(for tool in "sphere_12_7 6.35" "sphere_3_2 1.6"; do
  awk -F, -v r="${tool#* }" 'NR > 101 && $13 < 12 { d = 220 - $4; f = 4 / 3 * sqrt(r) * 3.45 * d ^ 1.5; e = ($13 - f) / f; print e < 0 ? -e : e }' "$out/2002_table1_${tool% *}.csv"
done | sort -g | tail -1)
press tools_on_cylinder --with tools/sphere_3_2_true.toml --path "$out/2002_press_path.csv" --out "$out/2002_true_sphere.csv"
a=$(at true_sphere 1500) b=$(at table1_sphere_3_2 1500)
claim "a true sphere of 3.2 mm is softer than what they measured: $a against $b N at 1.5 mm" "$a < 0.95 * $b && $a > 0.88 * $b"
stated "Fig. 6: localised" "the true sphere %.1f N" "$a"
claim "Fig. 6: below 12 N the spheres are Table 1's to $off of themselves" "$off < 0.02"
stated "Fig. 6: Table 1 fits" "%.1f %%" "$(awk "BEGIN { print 100 * $off }")"
for tool in sphere_12_7 sphere_3_2_true; do press tools_on_layer --with "tools/$tool.toml" --out "$out/2002_fig7_$tool.csv"; done
a=$(largest "$out/2002_fig7_sphere_12_7.csv" f_N) c=$(largest "$out/2002_fig7_sphere_3_2_true.csv" f_N)
claim "Fig. 7: on liver the tools differ: $a and $c N" "$a > 1.2 * $c"
stated "Fig. 7: liver" "%.2f and %.2f N" "$a" "$c"
press tools_on_cylinder --out "$out/2002_fig8.csv" --plot "$out/2002_fig8.svg"
spread=$(awk -F, 'NR > 4501 && NR < 5800 { if (low == "" || $11 < low) low = $11; if ($11 > high) high = $11 } END { print (high - low) / high }' "$out/2002_fig8.csv")
claim "Fig. 8: sliding along the body changes the normal force by $spread of itself" "$spread < 0.02"

# Their sphere of 3.2 mm: down to around 14 N, then three times to and fro over 10 mm.
awk 'BEGIN { print "time_s,x_mm,y_mm,z_mm"; for (i = 0; i <= 15000; i++) { k = (i - 3000) % 4000; x = i < 3000 ? 0 : (k < 2000 ? k : 4000 - k) / 200
  printf "%g,%g,%g,0\n", i / 1000, x, 220 - 1.8 * (i < 3000 ? i / 3000 : 1) } }' >"$out/2002_slide_path.csv"
press tools_on_cylinder --with tools/sphere_3_2.toml --path "$out/2002_slide_path.csv" \
  --out "$out/2002_fig8_sphere_3_2.csv" --plot "$out/2002_fig8_sphere_3_2.svg"
a=$(column "$out/2002_fig8_sphere_3_2.csv" fx_N | sort -g | head -1) b=$(largest "$out/2002_fig8_sphere_3_2.csv" fx_N) c=$(largest "$out/2002_fig8_sphere_3_2.csv" fy_N)
claim "Fig. 8: around 14 N ($c), friction from -7 to 7 N ($a to $b)" "$c > 13.5 && $c < 14.5 && $a < -6.7 && $a > -7.3 && $b > 6.7 && $b < 7.3"
stated "Fig. 8: normal force" "%.2f N" "$c"
stated "Fig. 8: normal force" "%.2f to %.2f N" "$a" "$b"

# Every law as printed: curves of single presses at two places, the second half as stiff, interpolated by eqs. 3 and 4.
# Down to 1.5 mm at the first place, over to the second and halfway back.
awk 'BEGIN { print "time_s,x_mm,y_mm,z_mm"; for (i = 0; i <= 15500; i++) { x = i < 1500 ? -40 : (i < 9500 ? -40 + (i - 1500) / 100 : 40 - (i - 9500) / 100)
  printf "%g,%g,%g,0\n", i / 1000, x, 220 - 1.5 * (i < 1500 ? i / 1500 : 1) } }' >"$out/2002_printed_path.csv"
press tools_on_cylinder --with laws/mahvash_hayward_2002.toml --path "$out/2002_printed_path.csv" --out "$out/2002_printed.csv"
a=$(awk -F, 'NR == 1502 { print $11 + 0 }' "$out/2002_printed.csv") b=$(awk -F, 'NR == 9502 { print $11 + 0 }' "$out/2002_printed.csv")
claim "eq. 3 by curves of table 1: $a N at 1.5 mm on their rubber (21.29), $b N where it is half as stiff" \
  "$a > 0.995 * 21.295 && $a < 1.005 * 21.295 && $b > 0.995 * $a / 2 && $b < 1.005 * $a / 2"
stated "every law as printed | overlay \`laws/mahvash" "%.2f N at 1.5 mm and %.2f N at the soft place" "$a" "$b"
a=$(awk -F, 'NR > 1503 && NR < 9500 { d = $11 - last; if (d < 0) d = -d; if (NR > 1504 && d > most) most = d; if (NR > 1504 && $11 > last + 1e-9) rises++ } { last = $11 } END { print most + 1000 * rises }' \
  "$out/2002_printed.csv")
claim "eq. 4 makes the force continuous: it falls from place to place by at most $a N in 10 um" "$a < 0.02"
a=$(awk -F, 'NR == 9400 { print -$10 / $11 }' "$out/2002_printed.csv") b=$(awk -F, 'NR == 9600 { print $10 / $11 }' "$out/2002_printed.csv")
c=$(awk -F, 'NR > 9502 && !done && $10 > 0.49999 * $11 { print (NR - 9502) / 100; done = 1 }' "$out/2002_printed.csv")
claim "friction by pre-sliding displacement: $a of the normal force, turned round after $c mm" "$a > 0.4999 && $a < 0.5001 && $b > 0.4999 && $b < 0.5001 && $c > 0.15 && $c < 0.25"
stated "every law as printed | overlay \`laws/mahvash" "friction %.3f of that, turned round over %.1f mm" "$a" "$c"
a=$("$palpate" bake tools_on_cylinder.toml --with laws/mahvash_hayward_2002.toml -o "$out/2002_printed.pal" --report 2>>"$log" | grep -oE '[0-9]+ bytes per vertex')
stated "20 numbers a vertex" "%s" "$a"

echo "== Duriez, Andriot & Kheddar 2003"
press snap_in_paper --out "$out/2003_snap.csv" --plot "$out/2003_snap.svg" --png "$out/2003_snap.png"
low=$(column "$out/2003_snap.csv" fy_N | sort -g | head -1) high=$(largest "$out/2003_snap.csv" fy_N)
claim "the snap: pushes with up to $high N, then pulls with up to $low N" "$high > 2 && $low < -2"
stated "Figs. 5, 6: the snap" "%.2f N, then %.2f N" "$high" "$low"
# Drawn at the largest force of the path, which is one place.
for y in 13 11 6 0; do
  awk -v y="$y" 'BEGIN { print "x_mm,y_mm,z_mm"; for (i = 0; i < 100; i++) printf "0,%g,0\n", y }' >"$out/2003_frame_path.csv"
  press snap_in_paper --path "$out/2003_frame_path.csv" --out "$out/2003_fig5_$y.csv" --png "$out/2003_fig5_$y.png"
done
arms() { tail -1 "$out/2003_fig5_$1.csv" | cut -d, -f21; }
a=$(arms 13) b=$(arms 11) c=$(arms 6)
claim "Fig. 5: two arms touch the tube as they open and close: $a, $b, $c regions" "$a == 2 && $b == 2 && $c == 2"
# Between its flats the prism is 2 % slimmer than the tube and spreads the arms by 7 % less: 0.86 of the energy, or more.
awk 'BEGIN { print "x_mm,y_mm,z_mm"; for (i = 0; i <= 2800; i++) printf "0,%g,0\n", 14.5 - 0.005 * i; }' >"$out/2003_in_path.csv"
press snap_in_paper --with tubes/prism_16.toml --set friction.law=none --path "$out/2003_in_path.csv" --out "$out/2003_prism.csv"
press snap_in_paper --set friction.law=none --path "$out/2003_in_path.csv" --out "$out/2003_tube.csv"
far=$(largest "$out/2003_tube.csv" residual_m)
claim "Fig. 1: no node inside the tool, none pushed that does not touch, to $far m" "$far < 1e-7"
a=$(largest "$out/2003_prism.csv" energy_J) b=$(largest "$out/2003_tube.csv" energy_J)
claim "a tube or any other shape: a prism of 16 sides stores $a J on its way in, the tube $b J" "$a > 0.86 * $b && $a < $b"

echo "== Cui & Xiao 2008"
"$palpate" grasp grasp_cylinder_2.toml grasp_cylinder_3.toml grasp_cylinder_5.toml --out "$out/2008_fig6_to_8" >"$out/2008_cylinder.txt" 2>>"$log"
"$palpate" grasp grasp_sphere_2.toml grasp_sphere_3.toml grasp_sphere_5.toml --out "$out/2008_fig9" >"$out/2008_sphere.txt" 2>>"$log"
"$palpate" grasp grasp_cylinder_2.toml grasp_cylinder_3.toml grasp_cylinder_5.toml --with laws/cui_xiao_2008.toml \
  --out "$out/2008_fig7_printed" >"$out/2008_cylinder_printed.txt" 2>>"$log"
"$palpate" grasp grasp_sphere_2.toml grasp_sphere_3.toml grasp_sphere_5.toml --with bodies/sphere_rings.toml \
  --out "$out/2008_fig9_rings" >"$out/2008_sphere_rings.txt" 2>>"$log"
"$palpate" grasp grasp_cylinder_5.toml --with hands/mesh_contact.toml --out "$out/2008_mesh_contact" >"$out/2008_mesh_contact.txt" 2>>"$log"
# stress FOLDER FINGERS FIRST LAST: sum over anchors FIRST to LAST at the hold, 3 s.
stress() { awk -F, -v first="$3" -v last="$4" '$1 == 3 { for (i = first; i <= last; i++) sum += $(i + 1) } END { print sum + 0 }' "$out/$1/grasp_cylinder_$2.stress.csv"; }
a=$(stress 2008_fig6_to_8 2 1 8) b=$(stress 2008_fig6_to_8 3 1 8) c=$(stress 2008_fig6_to_8 5 1 8)
claim "Fig. 7: more fingers, more stress at the anchors: $a, $b, $c Pa in all" "$a > 0 && $b > $a && $c > $b"
thousandth() { awk "BEGIN { print $1 / 1000 }"; }
stated "Fig. 7: more fingers" "%.1f, %.1f, %.1f kPa over the eight" "$(thousandth "$a")" "$(thousandth "$b")" "$(thousandth "$c")"
steep=""
for fingers in 2 3 5; do
  # Anchors 1, 2 and 5, 6 are on the side of the contacts' middle, 5 to 8 on the rim next to the hand.
  near=$(stress 2008_fig7_printed $fingers 1 2) beyond=$(stress 2008_fig7_printed $fingers 3 4)
  near_top=$(stress 2008_fig7_printed $fingers 5 6) beyond_top=$(stress 2008_fig7_printed $fingers 7 8)
  claim "Fig. 7 by the printed laws, $fingers fingers: within a rim $near_top falls to $beyond_top Pa, and $near to $beyond" \
    "$near_top > 1.05 * $beyond_top && $near > 1.05 * $beyond"
  stated "Fig. 7: more fingers" "%.1f and %.1f" "$(thousandth "$near_top")" "$(thousandth "$beyond_top")"
  stated "Fig. 7: more fingers" "%.1f and %.1f" "$(thousandth "$near")" "$(thousandth "$beyond")"
  steep+=" $(awk "BEGIN { print ($near_top + $beyond_top) / ($near + $beyond) }")"
done
read -r a b c <<<"$steep"
claim "Fig. 7 by the printed laws: the drop between the rims is $a, $b, $c, least steep for five fingers" "$a > $b && $b > $c && $c > 1"
stated "Fig. 7: more fingers" "rims' ratio %.1f, %.1f, %.1f" "$a" "$b" "$c"
needed() { grep -o 'friction needed: [0-9.]*' "$out/$1" | grep -o '[0-9.]*$' | sort -g | paste -sd' '; }
read -r _ _ a <<<"$(needed 2008_cylinder_printed.txt)"
stated "Fig. 7: more fingers" "needs %.2f of the friction" "$a"
rise=$(awk -F, 'NR == 2 { for (i = 2; i <= NF; i++) if ($i != 0) bad = 1 } NR > 1 { for (i = 2; i <= NF; i++) { if ($i > top[i]) top[i] = $i; if ($1 == 3) held[i] = $i } }
  END { for (i in top) if (held[i] < 0.9 * top[i]) bad = 1; print bad + 0 }' "$out/2008_fig7_printed/grasp_cylinder_5.stress.csv")
claim "Fig. 8: every stress starts at zero and is largest while held" "$rise == 0"
regions=$(awk '/regions/ { printf "%d ", $2 }' "$out/2008_sphere_rings.txt")
claim "Fig. 9: the sphere of 3,480 triangles is held by ${regions}regions" "$(tr ' ' '+' <<<"${regions% }") == 30 && ${regions##*9 } == 15"
read -r a b c <<<"$regions"
stated "Fig. 9: three grasps" "%d, %d and %d regions" "$a" "$b" "$c"
read -r a b c <<<"$(grep -o 'friction needed: [0-9.]*' "$out/2008_sphere_rings.txt" | grep -o '[0-9.]*$' | paste -sd' ')"
stated "Fig. 9: three grasps" "%.3f, %.3f and %.3f of the stated friction" "$a" "$b" "$c"
stated "Fig. 9: three grasps" "the least part %.3f N" "$(awk '/^  [a-z]+ [a-z]+ +[0-9.]+ N$/ { print $3 }' "$out/2008_sphere_rings.txt" | sort -g | head -1)"
regions=$(awk '/regions/ { printf "%d", $2 }' "$out/2008_mesh_contact.txt")
claim "the parts touch with the surface of the hand's mesh: $regions regions" "$regions == 15"
over_parts() { awk '/^grasp/ { on = /grasp_cylinder_5/ } on && /^  [a-z]+ [a-z]+ +[0-9.]+ N$/ { sum += $3 } END { print sum }' "$out/$1"; }
stated "contact with the hand's mesh" "%.2f N over the parts, capsules %.2f" "$(over_parts 2008_mesh_contact.txt)" "$(over_parts 2008_cylinder.txt)"
stable=$(cat "$out"/2008_cylinder.txt "$out"/2008_sphere.txt "$out"/2008_sphere_rings.txt | grep -c '^  stable:')
claim "the $stable grasps of Figs. 6 and 9 hold their weight within the friction cones" "$stable == 9"
unstable=$(grep -h 'UNSTABLE' "$out/2008_cylinder_printed.txt" | sed 's/.*needed: //' || true)
claim "of the printed laws' three grasps of the cylinder one does not hold and is told so: needs $unstable" \
  "$(grep -c 'UNSTABLE' "$out/2008_cylinder_printed.txt" || true) == 1 && ${unstable% of it} > 1"
"$palpate" grasp grasp_cylinder_2.toml grasp_cylinder_3.toml grasp_cylinder_5.toml grasp_sphere_2.toml grasp_sphere_3.toml \
  grasp_sphere_5.toml --with hands/balanced.toml --out "$out/2008_balanced" >"$out/2008_balanced.txt" 2>>"$log"
off=$(grep -h 'normal force of each finger' "$out/2008_balanced.txt" | grep -o '\(index\|middle\|ring\|little\) [0-9.]*' |
  awk '{ e = $2 < 1 ? 1 - $2 : $2 - 1; if (e > most) most = e } END { print most + 0 }')
stable=$(grep -c '^  stable:' "$out/2008_balanced.txt" || true)
claim "fingers that stop by force press with 1 N to $off N, the thumb opposes them, and $stable grasps hold" "$stable == 6 && $off < 0.001"
a=$(cat "$out"/2008_cylinder.txt "$out"/2008_sphere.txt | grep -o 'friction needed: [0-9.]*' | grep -o '[0-9.]*$' | sort -g | paste -sd' ')
stated "palm balances the fingers" "%.2f to %.2f of the friction" "${a%% *}" "${a##* }"
if [ -n "$sheets" ]; then
  "$sheets" "$out" && echo "sheets  $out/papers_2002.png to papers_2009.png" || status=1
fi
echo "figures: $out"
exit $status
