#!/usr/bin/env bash
# Writes the manual pages of palpate, of each of its commands and of palpate-rt and palpate-device into a folder, from what
# their --help says. Usage: manual.sh PALPATE VERSION FOLDER
set -euo pipefail
usage="usage: manual.sh PALPATE VERSION FOLDER"
palpate=${1:?$usage} version=${2:?$usage} folder=${3:?$usage}
mkdir -p "$folder"
commands=$("$palpate" --help | awk '/^Subcommands:/ { on = 1; next } /^$/ { on = 0 } on { printf "%s ", $1 }')
[ -n "$commands" ] || { echo "manual: $palpate --help names no commands" >&2; exit 1; }

# Help (title, usage, sections of two columns, text, "Examples:") to roff. What begins a line with a dot or a quote would
# be a request.
page() { # NAME, of what reads from standard input
  awk -v name="$1" -v version="$version" '
    function text(line) {
      gsub(/\\/, "\\e", line)
      gsub(/-/, "\\-", line)
      if (line ~ /^[.\047]/) line = "\\&" line
      return line
    }
    function entry(line,  names, told) {
      line = substr(line, 3)
      names = line
      told = ""
      if (match(line, /   *[^ ]/)) {
        names = substr(line, 1, RSTART - 1)
        told = substr(line, RSTART)
        sub(/^ */, "", told)
      }
      gsub(/,/, ", ", names)
      printf ".TP\n.B %s\n%s\n", text(names), text(told)
    }
    NR == 1 {
      if (match($0, /^palpate[a-z-]* .*: /)) synopsis = substr($0, 1, RLENGTH - 2)
      sub(/^palpate[a-z-]* .*: /, "")
      printf ".TH %s 1 \"\" \"palpate %s\" \"Palpate\"\n.SH NAME\n%s \\- %s\n", toupper(name), version, name, text($0)
      if (synopsis != "") printf ".SH SYNOPSIS\n.B %s\n", text(synopsis)
      next
    }
    /^Usage: / {
      sub(/^Usage: [^ ]*palpate[a-z-]*/, "palpate")
      printf ".SH SYNOPSIS\n.B %s\n", text($0)
      next
    }
    /^(Options|Positionals|Subcommands):$/ { section = toupper(substr($0, 1, length($0) - 1)); printf ".SH %s\n", section; next }
    /^Examples:$/ { printf ".SH EXAMPLES\n.nf\n"; section = "EXAMPLES"; next }
    section == "EXAMPLES" { print text($0); next }
    /^$/ { section = ""; next }
    /^  -/ && section == "" { section = "OPTIONS"; print ".SH OPTIONS" }
    section != "" && /^  [^ ]/ { entry($0); next }
    section != "" { sub(/^ */, ""); print text($0); next }
    { if (!said++) print ".SH DESCRIPTION"; print text($0) }
    END {
      if (section == "EXAMPLES") print ".fi"
      print ".SH SEE ALSO"
      print name == "palpate" ? ".BR palpate\\-COMMAND (1)" : ".BR palpate (1)"
    }'
}

"$palpate" --help | page palpate >"$folder/palpate.1"
for command in $commands; do
  help=$("$palpate" "$command" --help 2>/dev/null) || continue # a program of its own that was not built
  page "palpate-$command" <<<"$help" >"$folder/palpate-$command.1"
done
for program in palpate-rt palpate-device; do
  "$(dirname "$palpate")/$program" --help | page "$program" >"$folder/$program.1"
done
