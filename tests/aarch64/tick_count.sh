#!/usr/bin/env bash
# Gate: instructions on AArch64 of each scene's worst tick under the scripted hand, as tests/bench counts them on x86-64,
# against budgets.txt. Usage:
#   tick_count.sh count TICK_COUNT IMAGE_DIR JOBS    counts and judges every scene
#   tick_count.sh judge COUNTS BUDGETS               judges lines "SCENE worst tick N instructions ..."
set -euo pipefail
usage='usage: tick_count.sh count TICK_COUNT IMAGE_DIR JOBS | judge COUNTS BUDGETS'
mode=${1:?$usage}
here=$(cd "$(dirname "$0")" && pwd)

# A scene without a count or without a budget is a failure, too.
judge() { # COUNTS BUDGETS
  awk -v budgets="$2" 'BEGIN { while ((getline line < budgets) > 0) { split(line, f, " "); if (line !~ /^#/) budget[f[1]] = f[2] } }
    $2 == "worst" && $4 > 0 {
      counted[$1]; verdict = !($1 in budget) ? "NO BUDGET" : $4 > budget[$1] ? "OVER BUDGET" : "ok"
      if (verdict != "ok") bad = 1
      printf "%-26s worst tick %7d of %7d instructions: %s\n", $1, $4, budget[$1], verdict; next }
    { print "not counted: " $0; bad = 1 }
    END { for (scene in budget) if (!(scene in counted)) { print scene ": not counted"; bad = 1 }
      exit bad || NR == 0 }' "$1"
}

if [ "$mode" = judge ]; then
  judge "${2:?$usage}" "${3:?$usage}"
  exit
fi
[ "$mode" = count ] || { echo "$usage"; exit 2; }
program=${2:?$usage} images=${3:?$usage} jobs=${4:?$usage}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
gcc -O2 -Wall -Wextra -Werror -shared -fPIC "$here/count_plugin.c" -o "$work/count.so"
# A file for each scene: processes that print at once would mix their lines.
printf '%s\0' "$images"/*.pal | xargs -0 -P "$jobs" -I IMAGE sh -c '
  scene=$(basename "$4" .pal)
  printf "%s %s\n" "$scene" "$("$1" -plugin "$2/count.so" "$3" "$4" 2>&1)" >"$2/$scene.txt"' \
  count "$here/emulator.sh" "$work" "$program" IMAGE
cat "$work"/*.txt >"$work/counts"
cat "$work/counts"
judge "$work/counts" "$here/budgets.txt"
