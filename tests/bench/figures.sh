#!/usr/bin/env bash
# Are the figures of the README younger than the code they describe? figures.txt lists them: the words of the figure, the
# day it was measured, the command that measures it, and the files it depends on. A figure is too old when one of those
# files was committed on a later day, or differs from what is committed. Every row of the README's table needs an entry.
# Usage: figures.sh ROOT [TABLE]
# Exit status: 0 all are current, 1 some are older than their code, or the table and the README disagree.
set -euo pipefail
root=${1:?usage: figures.sh ROOT [TABLE]}
cd "$root"
table=${2:-tests/bench/figures.txt}
git rev-parse >/dev/null 2>&1 || { echo "figures: $root is no git checkout, which alone knows when code changed"; exit 1; }
problems=0 figures=0
report() {
  echo "$1"
  problems=$((problems + 1))
}
trim() { sed -E 's/^[[:space:]]+|[[:space:]]+$//g' <<<"$1"; }

rows=$(sed -n '/^| what it guarantees /,/^$/p' README.md | sed -n '3,$p' | grep '^|' || true)
[ -n "$rows" ] || { echo "figures: README.md has no table 'what it guarantees'"; exit 1; }
covered=
while IFS='|' read -r words day command sources; do
  words=$(trim "$words") day=$(trim "$day") command=$(trim "$command") sources=$(trim "$sources")
  figures=$((figures + 1))
  row=$(grep -nF -- "$words" <<<"$rows" | head -n 1 | cut -d : -f 1 || true)
  [ -n "$row" ] || { report "README.md does not say \"$words\": $table does"; continue; }
  covered+=" $row "
  grep -qF -- "$command" <<<"$(sed -n "${row}p" <<<"$rows")" || report "README.md: \"$words\" does not name its command: $command"
  # shellcheck disable=SC2086  # a list of paths
  changed=$(git log -1 --format=%cs -- $sources)
  [ -n "$changed" ] || { report "$table: nothing was ever committed in: $sources"; continue; }
  [[ ! $day < $changed ]] ||
    report "README.md: \"$words\" was measured on $day, its code changed on $changed ($sources): run $command"
  # shellcheck disable=SC2086
  [ -z "$(git status --porcelain -- $sources)" ] || report "README.md: \"$words\": its code has changes that are not committed"
done < <(grep -vE '^(#|$)' "$table")
count=$(wc -l <<<"$rows")
for ((row = 1; row <= count; row++)); do
  [[ $covered == *" $row "* ]] || report "$table: nothing about the README's row $(sed -n "${row}p" <<<"$rows" | cut -c 1-60)"
done
[ "$problems" -eq 0 ] || { echo "figures: $problems problems in $figures figures"; exit 1; }
echo "figures: $figures, none older than its code"
