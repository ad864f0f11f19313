#!/usr/bin/env bash
# Effect gate, a mutation test of the tick: what changes nothing must not be in the tick. Every statement of tick(),
# render(), find_forces() and contact(), the phases of every contact method one method at a time, the skeletons of
# `temporal_paper` and `mutual_paper` coupling and the printed laws of tips are left out in turn: a copy of the source
# without that line is compiled and linked before the library, whose own version is then not taken. Some scene's outputs
# must change over the scripted hand's eight seconds, or the run must not end at all. Proves itself by a planted stage
# that computes what nobody reads.
# Usage: effect.sh CXX ROOT LIBRT_CORE PALPATE IMAGE_DIR
set -euo pipefail
usage="usage: effect.sh CXX ROOT LIBRT_CORE PALPATE IMAGE_DIR"
cxx=${1:?$usage} root=${2:?$usage} library=${3:?$usage} palpate=${4:?$usage} images=${5:?$usage}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags="-std=c++20 -O2 -march=x86-64-v3 -ffp-contract=off -mno-fma -w -I$root -isystem /usr/include/eigen3"

# Every method of contact, from their one list.
methods=$(sed -n 's/^#define PALPATE_METHODS(X)//p' "$root/rt_core/laws.h" | grep -oE 'k[A-Z][A-Za-z]*')
[ "$(wc -w <<<"$methods")" -ge 3 ] || { echo "the list of methods was not found in rt_core/laws.h"; exit 1; }

# One scene of each method and kind, cheapest first: a run stops at the first one that changes.
"$palpate" bake "$root/config/scenes/heart_compass_paper.toml" -o "$work/temporal.pal" \
  >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$palpate" bake "$root/config/scenes/heart_compass_paper.toml" --with "$root/config/scenes/laws/luo_xiao_2006.toml" -o "$work/mutual.pal" \
  >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$palpate" bake "$root/config/scenes/tools_on_cylinder.toml" --with "$root/config/scenes/laws/mahvash_hayward_2002.toml" -o "$work/curves.pal" \
  >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$palpate" bake "$root/config/scenes/tools_on_layer.toml" --set device.holds=body -o "$work/held.pal" \
  >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
# Of a face with three points the body may be between them: libccd tells that it touches. Balls and capsules know without.
sed 's/^points = 9/points = 3/' "$root/config/scenes/ellipsoid_mallet_springs.toml" >"$work/sparse.toml"
"$palpate" bake "$work/sparse.toml" -o "$work/sparse.pal" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
scenes="$images/tools_on_layer.pal $images/ellipsoid_mallet_springs.pal $work/temporal.pal $images/grasp_cylinder_2.pal $work/held.pal"
scenes+=" $images/pinch_block_nodal.pal $images/ring.pal $work/mutual.pal $work/curves.pal $work/sparse.pal"

# shellcheck disable=SC2086
"$cxx" $flags -c "$root/tests/gates/output_hash.cpp" -o "$work/output_hash.o"
"$cxx" "$work/output_hash.o" "$library" -lccd -o "$work/whole"
for scene in $scenes; do "$work/whole" "$scene"; done >"$work/expected"

status=0 count=0
# changes SOURCE: prints the first scene whose outputs are others when SOURCE stands in for the library's own file.
changes() {
  # shellcheck disable=SC2086
  "$cxx" $flags -c "$1" -o "$work/mutant.o" 2>"$work/log" || { cat "$work/log" >&2; return 2; }
  "$cxx" "$work/output_hash.o" "$work/mutant.o" "$library" -lccd -o "$work/mutant"
  local scene name expected
  for scene in $scenes; do
    if ! timeout 60 "$work/mutant" "$scene" >"$work/hash" 2>/dev/null; then echo "$(basename "$scene") does not end"; return 0; fi
    read -r name _ <"$work/hash"
    expected=$(sed -n "$(($(tr ' ' '\n' <<<"$scenes" | grep -nxF "$scene" | cut -d: -f1)))p" "$work/expected")
    if [ "$(cat "$work/hash")" != "$expected" ]; then echo "$name changes"; return 0; fi
  done
  return 1
}
# judge NAME SOURCE
judge() {
  local found
  count=$((count + 1))
  if found=$(changes "$2"); then
    printf '%-60s %s\n' "$1" "$found"
  else
    [ $? -eq 1 ] || { echo "$1: the copy without it does not compile"; exit 1; }
    printf '%-60s %s\n' "$1" "NO SCENE CHANGES: take it out of the tick, or add the scene that needs it"
    status=1
  fi
}
# statements FILE FUNCTION: line numbers of the calls in the body of FUNCTION, but stamps.
statements() {
  awk -v head="^void $2\\\\(" '$0 ~ head { body = 1 } body && /^}/ { body = 0 }
    body && /^  [a-z_. =()]*[a-z_]+\(.*\);$/ && !/^  (probe|mark|const)/ { print NR }' "$1"
}
# without FILE FUNCTION: judges FILE with every statement left out in turn, a method's phases one method at a time.
without() {
  local line text method
  for line in $(statements "$root/$1" "$2"); do
    text=$(sed -n "${line}s/^ *//p" "$root/$1")
    if [[ $text == method.* ]]; then
      for method in $methods; do
        sed "${line}s/method\\./if (method_of(model) != Method::$method) method./" "$root/$1" >"$work/mutant.cpp"
        judge "$2: $text $method" "$work/mutant.cpp"
      done
    else
      sed "${line}d" "$root/$1" >"$work/mutant.cpp"
      judge "$2: $text" "$work/mutant.cpp"
    fi
  done
}

without rt_core/tick.cpp tick
without rt_core/tick.cpp render
without rt_core/tick.cpp find_forces
[ "$count" -ge 8 ] || { echo "only $count statements found in tick.cpp: the gate no longer reads the source"; exit 1; }
without rt_core/contact/contact.cpp contact
[ "$count" -ge 18 ] || { echo "only $count statements found: the gate no longer reads the source"; exit 1; }
caller=$(grep -l 'add_transferred_forces(model' -r "$root/rt_core/contact")
sed 's/add_transferred_forces(model[^)]*)/true/' "$caller" >"$work/mutant.cpp"
judge "skeletons of temporal coupling" "$work/mutant.cpp"
sed 's/add_mutual_forces(model[^)]*)/true/' "$caller" >"$work/mutant.cpp"
judge "skeletons of mutual coupling" "$work/mutant.cpp"
# The printed laws of tips, which one overlay alone has: the curves' sum along the corners' normals, and friction with a
# constant slip distance.
judge_without() { # NAME FILE SED: a copy of FILE changed by SED, which must change it
  sed "$3" "$root/$2" >"$work/mutant.cpp"
  ! cmp -s "$root/$2" "$work/mutant.cpp" || { echo "$1: nothing to leave out in $2"; exit 1; }
  judge "$1" "$work/mutant.cpp"
}
judge_without "printed interpolation of curves" rt_core/contact/tips/tips.cpp 's/return printed_aside(.*;/return {};/'
judge_without "printed friction of tips" rt_core/contact/friction.cpp 's/== FrictionLaw::kPreslidingPaper/== FrictionLaw::kNone/'
# libccd decides something: whether a piece still touches where none of its points does.
for answer in 0 1; do
  echo "extern \"C\" int ccdGJKIntersect(const void*, const void*, const void*) { return $answer; }" >"$work/mutant.cpp"
  judge "ccdGJKIntersect that always says $answer" "$work/mutant.cpp"
done
judged=$status

# The gate must fire: a stage whose result nobody reads.
sed 's/^void render(/void waste(const State\& state) { volatile double sum = 0; for (double k : state.contact_stiffness) sum = sum + k; }\n&/
     s/^    make_safe(model/    waste(state);\n&/' "$root/rt_core/tick.cpp" >"$work/planted.cpp"
grep -q '^    waste(state);$' "$work/planted.cpp" || { echo "the planted stage was not planted"; exit 1; }
line=$(grep -nx '    waste(state);' "$work/planted.cpp" | cut -d: -f1)
statements "$work/planted.cpp" render | grep -qx "$line" || { echo "the planted stage was not found"; exit 1; }
sed "${line}d" "$work/planted.cpp" >"$work/mutant.cpp"
status=0
judge "tick: planted, must be named" "$work/mutant.cpp" >"$work/planted.log"
[ "$status" -eq 1 ] || { echo "the gate does not notice a stage without effect"; exit 1; }
echo "effect: $((count - 1)) statements judged; a planted one without effect was noticed"
exit "$judged"
