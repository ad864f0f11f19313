# Sourced by the gates: which files of a tree are ours. Usage after sourcing: `list_files ROOT EXTENSION...`,
# one path per line, relative to ROOT. Without git (an unpacked archive), everything outside build/ and out/.
list_files() {
  local root=$1 pattern
  shift
  pattern="\\.($(IFS='|' && echo "$*"))\$"
  [ "$*" != any ] || pattern=.
  if [ -e "$root/.git" ] && git -C "$root" rev-parse >/dev/null 2>&1; then
    git -C "$root" ls-files --cached --others --exclude-standard
  else
    (cd "$root" && find . -type f -not -path './build/*' -not -path './out/*' -not -path './.git/*' | sed 's|^\./||')
  fi | LC_ALL=C sort -u | grep -E "$pattern" | while IFS= read -r file; do
    [ ! -f "$root/$file" ] || printf '%s\n' "$file"
  done
}

# A source file's text with comments and string literals blanked, line numbers kept: `code_only FILE`.
code_only() {
  awk '
    {
      line = $0; out = ""
      while (length(line) > 0) {
        if (in_block) {
          end = index(line, "*/")
          if (end == 0) { line = ""; break }
          line = substr(line, end + 2); in_block = 0; continue
        }
        two = substr(line, 1, 2); one = substr(line, 1, 1)
        if (two == "//") { line = ""; break }
        if (two == "/*") { in_block = 1; line = substr(line, 3); continue }
        if (one == "\"" && line ~ /^"([^"\\]|\\.)*"/ && out !~ /^[ \t]*#[ \t]*include[ \t]*$/) {
          match(line, /^"([^"\\]|\\.)*"/); out = out "\"\""; line = substr(line, RLENGTH + 1); continue
        }
        out = out one; line = substr(line, 2)
      }
      print out
    }' "$1"
}
