#!/usr/bin/env bash
# References of the cases that are kept back: where each is pressed, how deep, and the solve itself (minutes each). The
# scenes and this table were committed before anything was solved, and are not to be changed with a result in hand;
# foam_ball, foam_rod, foam_saddle and edge came with their results.
# Usage: solve.sh PALPATE OUT [CASE...]
set -euo pipefail
palpate=${1:?usage: solve.sh PALPATE OUT [CASE...]} out=${2:?usage: solve.sh PALPATE OUT [CASE...]}
shift 2
here=$(cd "$(dirname "$0")" && pwd)

# case | place, mm | outward normal there | radius of the ball, mm | depth, mm
places='
pad|0,14,0|0,1,0|10|4
spheroid|0,72,0|0,1,0|5|4
triaxial|17.28,43.2,10.08|0.349645072,0.874112680,0.337157748|6|5
torus|28,24,0|0,1,0|7|5
box|10,30,-6|0,1,0|6|4
heart||0,1,0|6|4
dome|10.8,27,10.435516279|0.255802886,0.920890390,0.294152637|12|4
lentil|0,44,0|0,1,0|9|5
disc|0,16,0|0,1,0|8|4
small_torus|27,18,0|0,1,0|6|4
slab|0,22,0|0,1,0|7|4
loaf|0,44,0|0,1,0|8|4
foam_ball|0,68,0|0,1,0|9|5
foam_rod|0,60,0|0,1,0|8|6
foam_saddle|16,12,0|-1,0,0|6|3.5
foam_egg|13.44,68.4,11.88|0.585897,0.719521,0.372844|7|4
foam_dome|0,34,0|0,1,0|9|4
foam_tube|0,64,8|0,1,0|7|5
edge|23.5,30,0|0,1,0|6|3
rim|24,20,0|0,1,0|5|3
corner|18,26,14|0,1,0|6|3
tube|11.833311329,53.376618037,6|0.422618262,0.906307787,0|6|5
'
while IFS='|' read -r name place normal radius depth; do
  [ -n "$name" ] || continue
  [ $# -eq 0 ] || [[ " $* " == *" $name "* ]] || continue
  at=()
  [ -z "$place" ] || at=(--place="$place" --normal="$normal") # else the highest point
  "$palpate" report "$here/$name.toml" --solve "${at[@]}" --radius-mm "$radius" --depth-mm "$depth" --model elastic --quick \
    --out "$out"
done <<<"$places"
