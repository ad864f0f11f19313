#!/usr/bin/env bash
# Gate: what docs/security.md, docs/faults.md and docs/exit_codes.md say is tested, is. Every test they name exists; every
# attack in the table names one; every script in a row of faults.md is played by a test of the hal; every fault that is
# raised is in faults.md and in a test, and every verdict of sim_host/run/verdict.cpp in exit_codes.md.
# (That exit codes in table and header agree is tests/host/test_verdict.cpp's.)
# Usage: doc_tests.sh ROOT
set -euo pipefail
root=${1:?usage: doc_tests.sh ROOT}
cd "$root"
problems=0
report() {
  echo "$1"
  problems=$((problems + 1))
}

# "Suite.Name" of every test, one a line.
tests=$(grep -rhoE '^TEST(_F|_P)?\([A-Za-z0-9]+, [A-Za-z0-9]+' tests --include='*.cpp' | sed -E 's/^TEST(_F|_P)?\(//; s/, /./' | sort -u)
[ -n "$tests" ] || { echo "no tests found under $root/tests"; exit 1; }
exists() { # Suite.Name, Suite.*, Suite.Start..., fuzz.NAME
  case $1 in
    fuzz.*) grep -qE "^palpate_fuzzer\(${1#fuzz.} " tests/fuzz/CMakeLists.txt ;;
    *'.*') grep -q "^${1%'.*'}\\." <<<"$tests" ;;
    *...) grep -q "^${1%...}" <<<"$tests" ;;
    *) grep -qx "${1//./\\.}" <<<"$tests" ;;
  esac
}

for doc in docs/security.md docs/faults.md docs/exit_codes.md; do
  [ -f "$doc" ] || { report "$doc is missing"; continue; }
  while IFS= read -r name; do
    exists "$name" || report "$doc: names the test $name, which does not exist"
  done < <(grep -oE '`([A-Z][A-Za-z0-9]+\.([A-Z][A-Za-z0-9]*(\.\.\.)?|\*)|fuzz\.[a-z]+)`' "$doc" | tr -d '`' | sort -u)
done

# The last column of the attacks' table.
while IFS= read -r row; do
  [[ ${row##*| } =~ \`[A-Za-z]+\.[^\`]+\` ]] || report "docs/security.md: no test in the row: ${row:0:80}"
done < <(sed -n '/^| attack | answer | test |/,/^$/p' docs/security.md | sed -n '3,$p' | sed 's/ |$//' | grep '^|' || true)

# Scripts: (`lose 1`), several separated by commas. N stands for any number.
while IFS= read -r script; do
  [ -n "$script" ] || continue
  grep -rqE "\"([0-9.]+ )?${script// N/ -?[0-9.]+}[ \"0-9.]" tests/hal --include='*.cpp' ||
    report "docs/faults.md: no test in tests/hal plays \"$script\""
done < <(grep -E '^\| ' docs/faults.md | cut -d '|' -f 2 | grep -oE '\(`[^)]*\)' | grep -oE '`[a-z-]+( [-0-9.N]+)?`' | tr -d '`' | sort -u)

while IFS= read -r fault; do
  grep -rq "Fault::$fault\b" rt_core hal sim_host --include='*.cpp' --include='*.h' || continue  # nobody raises it
  grep -q "\`$fault\`" docs/faults.md || report "docs/faults.md: nothing about the fault $fault"
  grep -rq "Fault::$fault\b" tests --include='*.cpp' --include='*.h' || report "no test names Fault::$fault"
done < <(sed -n '/define PALPATE_FAULT_BITS/,/^$/p' rt_core/status.h | grep -oE 'X\(k[A-Za-z]+' | cut -c3-)

while IFS= read -r verdict; do
  grep -q "^| \`$verdict\` |" docs/exit_codes.md || report "docs/exit_codes.md: nothing about the verdict $verdict"
done < <(grep -oE '\{"[a-z]+", share' sim_host/run/verdict.cpp | cut -d '"' -f 2 | sort -u)

[ "$problems" -eq 0 ] || { echo "doc tests: $problems problems"; exit 1; }
echo "doc tests: $(wc -l <<<"$tests") tests known, no problem"
