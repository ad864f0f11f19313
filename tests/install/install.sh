#!/usr/bin/env bash
# The examples of docs/examples, built as a stranger would: against what `cmake --install` left, or with this tree taken in.
# Usage: install.sh installed|taken_in BUILD_DIR ROOT
set -euo pipefail
usage="usage: install.sh installed|taken_in BUILD_DIR ROOT"
mode=${1:?$usage} build=${2:?$usage} root=${3:?$usage}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
examples=$work/examples image=$build/scenes/ellipsoid_mallet.pal
configure() { cmake -S "$root/docs/examples" -B "$examples" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@"; }

if [ "$mode" = installed ]; then
  cmake --install "$build" --prefix "$work/prefix" >/dev/null
  ! grep -rlF -e "$root" -e "$build" "$work/prefix/lib" --include='*.cmake' || { echo "the package names the build's folders"; exit 1; }
  ! configure -Dpalpate_DIR=/nowhere >/dev/null 2>&1 || { echo "found without having been installed"; exit 1; }
  configure -DCMAKE_PREFIX_PATH="$work/prefix"
  cmake --build "$examples" --target embed_tick bake_and_press own_law
  "$work/prefix/bin/palpate" bake "$work/prefix/share/palpate/config/scenes/ellipsoid_mallet.toml" -o "$work/installed.pal"
  cmp "$work/installed.pal" "$image" || { echo "the installed program bakes another image"; exit 1; }
  "$examples/bake_and_press" "$root/config/scenes/ellipsoid_mallet.toml" >"$work/press.csv"
  awk -F, 'NR > 2 && $2 < force { print "force falls while the depth grows: " $0; bad = 1 } NR > 1 { force = $2 } END { exit bad || NR < 50 }' "$work/press.csv"
  # A law of one's own pushes where the body is touched, and there alone; what its damping takes is a loop: more on the way in.
  "$examples/own_law" "$root/config/scenes/ellipsoid_mallet.toml" >"$work/own.csv"
  awk -F, 'NR == 1 { next } ($2 > 0.01 && $3 <= 0) || ($2 <= 0 && $3 != 0) { print "force without depth, or none with: " $0; bad = 1 }
    $2 > 0 && !($1 in down) { down[$1] = $3; next } $1 in down { if ($3 > down[$1] + 1e-9) { print "more on the way out: " $0; bad = 1 }; ++pairs }
    END { if (pairs < 20) print "own_law: " pairs + 0 " heights passed twice"; exit bad || pairs < 20 }' "$work/own.csv"
else
  configure -DPALPATE_SOURCE="$root"
  ! grep -q '^PALPATE_TESTS:BOOL=ON\|^PALPATE_WERROR:BOOL=ON' "$examples/CMakeCache.txt" || { echo "tests or -Werror are on in a project of others"; exit 1; }
  cmake --build "$examples" --target embed_tick
fi
said=$("$examples/embed_tick" "$image")
echo "$said"
# A tool that presses meets force, and none is left when it has gone.
[[ $said =~ 'at most '([0-9.]+)' N, at the end '-?0\.000 ]] && awk -v force="${BASH_REMATCH[1]}" 'BEGIN { exit !(force > 0.1) }'
