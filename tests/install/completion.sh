#!/usr/bin/env bash
# What Tab offers: every command and option that the help names, and behind an option what its help says belongs there.
# Usage: completion.sh PALPATE.BASH PALPATE
set -euo pipefail
usage="usage: completion.sh PALPATE.BASH PALPATE"
. "${1:?$usage}"
palpate=${2:?$usage}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir scenes
touch a.toml b.pal c.plr d.csv e.stl
problems=0

offered() { # LINE: what is offered at its end, sorted, in one line
  COMP_LINE=$1 COMP_POINT=${#1}
  _palpate_complete
  printf '%s\n' "${COMPREPLY[@]}" | LC_ALL=C sort | tr '\n' ' ' | sed 's/ *$//; s/^ *//'
}
expect() { # LINE WORD...
  local line=$1 found
  shift
  found=$(offered "$line")
  [ "$found" = "$*" ] || { echo "'$line': offers '$found', not '$*'"; problems=$((problems + 1)); }
}

complete -p palpate >/dev/null
expect 'palpate rec' recover
expect 'palpate --v' --version
expect 'palpate run ' a.toml b.pal scenes
expect 'palpate run a.toml --du' --duration
expect 'palpate run a.toml --duration '
expect 'palpate run a.toml --quiet ' a.toml b.pal scenes
expect 'palpate run --path ' d.csv scenes
expect 'palpate press --set '
expect 'palpate press --allow '
expect 'palpate replay ' c.plr scenes
expect 'palpate run a.toml --device lo' loopback
expect 'palpate latency --load ' host none
expect 'palpate device-test au' auto
expect 'palpate nonsense '
expect 'palpate nonsense --'
# A CAN interface and its colon, where bash cuts words there and where it does not.
_palpate_addresses() { printf '%s\n' auto loopback can:can0 can:can1 usb:/dev/hidraw2; }
COMP_WORDBREAKS=$' \t\n"\'><=;|&(:'
expect 'palpate run a.toml --device can:' can0 can1
COMP_WORDBREAKS=$' \t\n'
expect 'palpate run a.toml --device can:' can:can0 can:can1

grep -q '^  palpate run config/scenes/' <<<"$("$palpate")" || { echo "palpate alone does not say how to begin"; problems=$((problems + 1)); }
commands=$("$palpate" --help | sed -n 's/^  \([a-z-]*\)   .*/\1/p')
[ "$(wc -w <<<"$commands")" -ge 12 ] || { echo "the help names too few commands: $commands"; exit 1; }
for command in $commands; do
  [[ " $(offered 'palpate ') " == *" $command "* ]] || { echo "the command $command is not offered"; problems=$((problems + 1)); }
  options=$(offered "palpate $command -")
  for option in $({ "$palpate" "$command" --help 2>/dev/null || true; } | grep -E '^  -' | grep -oE '^  [^ ]+' | tr ',' ' '); do
    [[ " $options " == *" $option "* ]] || { echo "the option $command $option is not offered"; problems=$((problems + 1)); }
  done
done
[ "$problems" -eq 0 ] || { echo "completion: $problems problems"; exit 1; }
echo "completion: no problem"
