#!/usr/bin/env bash
# Writes what bash needs to complete `palpate` on Tab, from what `palpate --help` and `palpate COMMAND --help` say: commands,
# options, and what comes behind each: files of the kinds that its help names, one of a list, a device's address.
# Usage: completion.sh PALPATE >FILE
set -euo pipefail
palpate=${1:?usage: completion.sh PALPATE}
commands=$("$palpate" --help | awk '/^Subcommands:/ { on = 1; next } /^$/ { on = 0 } on { printf "%s ", $1 }')
[ -n "$commands" ] || { echo "completion: $palpate --help names no commands" >&2; exit 1; }

# One line for each option and for the positional arguments (.) of COMMAND: ["COMMAND OPTION"]="kind". A kind of file is
# one in brackets or in a list: "(.toml)", "surface: .stl, .obj or .ply", but not "image of a .toml scene".
read_help() { # COMMAND; one whose program was not built has no help
  { "$palpate" "$1" --help 2>/dev/null || true; } | awk -v command="$1" '
    function kind(entry,  type, found, i, known) {
      type = entry
      sub(/^ *[^ ]+ */, "", type)
      if (type !~ /^(TEXT|INT|UINT|FLOAT)/) return ""
      if (match(type, /^TEXT:\{[^}]*\}/)) { found = substr(type, 7, RLENGTH - 7); gsub(/,/, " ", found); return "=" found }
      if (type !~ /^TEXT/ || entry ~ /(KEY|NAME)=VALUE|, as [a-z_]+=/) return "none"
      if (entry ~ /can:IFACE/) return "address"
      found = ""
      for (i = split("toml pal plr part csv png svg stl obj ply json", known, " "); i > 0; --i)
        if (tolower(entry) ~ "(\\(|[*]|, |: |or |this )[.]?" known[i] "([^a-z]|$)") found = found " " known[i]
      return "files" found
    }
    function flush(  field, names, i, what) {
      if (entry == "") return
      what = kind(entry)
      split(entry, field, " ")
      if (section == "Positionals:") printf "  [\"%s .\"]=\"%s\"\n", command, what
      if (section == "Options:")
        for (i = split(field[1], names, ","); i > 0; --i) {
          all = all " " names[i]
          if (what != "") printf "  [\"%s %s\"]=\"%s\"\n", command, names[i], what
        }
      entry = ""
    }
    /^[A-Z][a-z]+:$/ { section = $0; next }
    /^$/ { flush(); section = "" }
    section != "" && /^  [^ ]/ { flush(); entry = $0; next }
    section != "" { entry = entry " " $0 }
    END { flush(); printf "  [\"%s\"]=\"%s\"\n", command, substr(all, 2) }'
}

echo "# Completion of palpate for bash, written by sim_host/completion.sh from its help."
echo "declare -gA _palpate=("
echo "  [commands]=\"${commands% }\""
for command in $commands; do read_help "$command"; done
cat <<'TEXT'
)

_palpate_files() { # CURRENT [EXTENSION...]: folders, and files of these kinds, or any
  local current=$1 extension
  shift
  [ $# -gt 0 ] || { compgen -f -- "$current"; return; }
  compgen -d -- "$current"
  for extension in "$@"; do compgen -f -X "!*.$extension" -- "$current"; done
}

_palpate_addresses() {
  local file
  echo auto loopback
  for file in /sys/class/net/*; do # 280: CAN
    [ "$(cat "$file/type" 2>/dev/null)" != 280 ] || echo "can:${file##*/}"
  done
  for file in /dev/hidraw*; do
    [ ! -e "$file" ] || echo "usb:$file"
  done
}

_palpate_complete() {
  # Not COMP_WORDS: those are cut at the colon of an address.
  local line=${COMP_LINE:0:COMP_POINT} words current kind head
  current=${line##* }
  read -ra words <<<"${line%"$current"}"
  COMPREPLY=()
  if [ "${#words[@]}" -le 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "${_palpate[commands]} --help --version" -- "$current")
    return
  fi
  kind=${_palpate["${words[1]} ${words[-1]}"]-}
  if [ -z "$kind" ] && [ "${current:0:1}" = - ]; then
    mapfile -t COMPREPLY < <(compgen -W "${_palpate[${words[1]}]-}" -- "$current")
    return
  fi
  kind=${kind:-${_palpate["${words[1]} ."]-}}
  case $kind in
    =*) mapfile -t COMPREPLY < <(compgen -W "${kind#=}" -- "$current") ;;
    address)
      head=${current%"${current##*:}"}
      mapfile -t COMPREPLY < <(compgen -W "$(_palpate_addresses)" -- "$current")
      [[ $COMP_WORDBREAKS != *:* ]] || COMPREPLY=("${COMPREPLY[@]#"$head"}")
      ;;
    files*)
      compopt -o filenames 2>/dev/null
      # shellcheck disable=SC2086  # a list of words
      mapfile -t COMPREPLY < <(_palpate_files "$current" ${kind#files})
      ;;
  esac
}
complete -F _palpate_complete palpate
TEXT
