#!/usr/bin/env bash
# Gate: dependencies point one way. rt_core includes rt_core, libccd (sources only) and a few standard
# headers that bring no heap, text, lock or clock; hal never sees config, nor config hal. Usage: include_direction.sh ROOT
set -euo pipefail
root=${1:?usage: include_direction.sh ROOT}
. "$(dirname "$0")/files.sh"

# Standard headers rt_core may use: types, bits and views. <atomic> is for the two rings shared with the host.
allowed_std=' array atomic bit concepts cstddef cstdint cstring initializer_list limits span type_traits utility '

problems=0
report() {
  echo "$1"
  problems=$((problems + 1))
}

check_include() { # FILE LINE KIND TARGET
  local file=$1 line=$2 kind=$3 target=$4 folder=${1%%/*} allowed
  case $folder in
    rt_core) allowed=rt_core ;;
    hal) allowed='rt_core|hal' ;;
    config) allowed='rt_core|config' ;;
    sim_host) allowed='rt_core|hal|config|sim_host' ;;
    *) return 0 ;;
  esac
  if [ "$kind" = quoted ]; then
    [[ $target =~ ^($allowed)/ ]] || report "$file:$line: $folder may include \"$allowed/...\" but not \"$target\""
  elif [ "$folder" = rt_core ]; then
    case $target in
      ccd/*) [[ $file == *.cpp ]] || report "$file:$line: <$target> belongs in a .cpp file, not in a header" ;;
      *) [[ $allowed_std == *" $target "* ]] || report "$file:$line: <$target> is not on rt_core's list of headers" ;;
    esac
  else
    [[ ! $target =~ ^(rt_core|hal|config|sim_host)/ ]] || report "$file:$line: write \"$target\", so that this gate sees it"
  fi
}

files=$(list_files "$root" cpp h h.in)
[ -n "$files" ] || report "no source files found under $root"
# One grep for as many files as fit a command line: a process for each of 1,300 took 18 to 40 s.
while IFS=: read -r file line text; do
  if [[ $text =~ include[[:space:]]*\"([^\"]+)\" ]]; then
    check_include "$file" "$line" quoted "${BASH_REMATCH[1]}"
  elif [[ $text =~ include[[:space:]]*\<([^\>]+)\> ]]; then
    check_include "$file" "$line" angle "${BASH_REMATCH[1]}"
  fi
done < <(cd "$root" && tr '\n' '\0' <<<"$files" | xargs -0 grep -HnE '^[[:space:]]*#[[:space:]]*include' || true)
[ "$problems" -eq 0 ] || { echo "include direction: $problems problems (the picture is in docs/architecture.md)"; exit 1; }
echo "include direction: $(wc -l <<<"$files") files, no problem"
