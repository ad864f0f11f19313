#!/usr/bin/env bash
# The figures of the five papers from the shipped scenes: pictures, curves and the numbers of docs/papers.md, into a
# folder. Exits with 1 when a trend that a paper states does not come out.
# Usage: figures.sh PALPATE FOLDER
set -euo pipefail
usage="usage: figures.sh PALPATE FOLDER"
palpate=$(realpath "${1:?$usage}") out=${2:?$usage}
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
# column FILE NAME: its values, one a line.
column() { awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) c = i; next } { print $c + 0 }' "$1"; }
largest() { column "$1" "$2" | sort -g | tail -1; }

echo "== Luo & Xiao 2006"
press ellipsoid_mallet_paper --out "$out/2006_fig10.csv" --plot "$out/2006_fig10.svg" --png "$out/2006_fig10.png"
force=$(largest "$out/2006_fig10.csv" f_N)
slips=$(grep -c ',slip,' "$out/2006_fig10.csv")
claim "Fig. 10: the force reaches ${force} N (axis to 25)" "$force > 24 && $force < 26"
claim "Fig. 10: the mallet slides compliantly, in $slips ticks" "$slips > 1000"
press heart_compass_paper --out "$out/2006_fig12.csv" --png "$out/2006_fig12.png"
regions=$(largest "$out/2006_fig12.csv" regions)
claim "Fig. 12: one, then $regions contact regions on the heart" "$regions == 2"

echo "== circular beams 2009"
press half_shell_paper --path "$root/docs/pictures/half_shell_press.csv" --resample --out "$out/2009_fig7.csv" \
  --png "$out/2009_fig7.png" --anchors "$out/2009_fig8.csv" --anchor-plot "$out/2009_fig8.png" --plotted-anchors 1,2,3,4,5
outer=""
for a in 1 2 3 4 5; do outer+=" $(largest "$out/2009_fig8.csv" a${a}_F_N)"; done
read -r f1 f2 f3 f4 f5 <<<"$(tr ' ' '\n' <<<"$outer" | sort -gr | tr '\n' ' ')"
claim "Fig. 8: nearer anchors carry more: $f1 $f2 $f3 $f4 $f5 N" "$f1 > $f2 && $f2 > $f3 && $f3 >= $f4 && $f4 > $f5 && $f5 > 0"
inner=$(for a in 6 7 8 9 10; do largest "$out/2009_fig8.csv" a${a}_F_N; done | sort -gr | tr '\n' ' ')
read -r f1 f2 f3 f4 f5 <<<"$inner"
claim "Fig. 8: so do the inner ones: ${inner}N" "$f1 > $f2 && $f2 > $f3 && $f3 >= $f4 && $f4 > $f5 && $f5 > 0"
press ring_paper --out "$out/2009_fig9.csv" --png "$out/2009_fig9.png"
press grasp_cylinder_5 --with bodies/hollow_cylinder.toml --out "$out/2009_fig10.csv" --png "$out/2009_fig10.png"
regions=$(largest "$out/2009_fig10.csv" regions)
claim "Fig. 10: the hand holds the hollow cylinder by $regions regions" "$regions == 15"

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
a=$(at local_sphere_12_7 1500) b=$(at local_flat_3_2 1500) c=$(at local_sphere_3_2 1500)
claim "Fig. 6: it is held: at 1.5 mm $a, $b, $c N" "$a > 1.2 * $b && $b > 1.5 * $c"
for tool in sphere_12_7 sphere_3_2; do press tools_on_layer --with "tools/$tool.toml" --out "$out/2002_fig7_$tool.csv"; done
a=$(largest "$out/2002_fig7_sphere_12_7.csv" f_N) c=$(largest "$out/2002_fig7_sphere_3_2.csv" f_N)
claim "Fig. 7: on liver the tools differ: $a and $c N" "$a > 1.2 * $c"
press tools_on_cylinder --out "$out/2002_fig8.csv" --plot "$out/2002_fig8.svg"
spread=$(awk -F, 'NR > 4501 && NR < 5800 { if (low == "" || $11 < low) low = $11; if ($11 > high) high = $11 } END { print (high - low) / high }' "$out/2002_fig8.csv")
claim "Fig. 8: sliding along the body changes the normal force by $spread of itself" "$spread < 0.02"

echo "== Duriez, Andriot & Kheddar 2003"
press snap_in --out "$out/2003_snap.csv" --plot "$out/2003_snap.svg" --png "$out/2003_snap.png"
low=$(column "$out/2003_snap.csv" fy_N | sort -g | head -1) high=$(largest "$out/2003_snap.csv" fy_N)
claim "the snap: pushes with up to $high N, then pulls with up to $low N" "$high > 2 && $low < -2"

echo "== Cui & Xiao 2008"
"$palpate" grasp grasp_cylinder_2.toml grasp_cylinder_3.toml grasp_cylinder_5.toml --out "$out/2008_fig6_to_8" >"$out/2008_cylinder.txt" 2>>"$log"
"$palpate" grasp grasp_sphere_2.toml grasp_sphere_3.toml grasp_sphere_5.toml --out "$out/2008_fig9" >"$out/2008_sphere.txt" 2>>"$log"
# Sum of the anchors' stresses at the hold, 3 s.
stress() { awk -F, '$1 == 3 { for (i = 2; i <= NF; i++) sum += $i } END { print sum + 0 }' "$out/2008_fig6_to_8/grasp_cylinder_$1.stress.csv"; }
a=$(stress 2) b=$(stress 3) c=$(stress 5)
claim "Fig. 7: more fingers, more stress at the anchors: $a, $b, $c Pa in all" "$a > 0 && $b > $a && $c > $b"
stable=$(cat "$out"/2008_cylinder.txt "$out"/2008_sphere.txt | grep -c '^  stable:')
claim "the $stable grasps of Figs. 6 and 9 hold their weight within the friction cones" "$stable == 6"
echo "figures: $out"
exit $status
