#!/usr/bin/env bash
# Proves that every gate can fire: each is given a sample that breaks its rule, and one that does not.
# Usage: self_test.sh COMPILER
set -euo pipefail
compiler=${1:?usage: self_test.sh COMPILER}
gates=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

failures=0
cases=0
expect() { # pass|fail NAME COMMAND...
  local wanted=$1 name=$2 got=pass
  shift 2
  "$@" >"$work/log" 2>&1 || got=fail
  cases=$((cases + 1))
  if [ "$got" != "$wanted" ]; then
    echo "$name: expected to $wanted, but it did $got:"
    sed 's/^/    /' "$work/log"
    failures=$((failures + 1))
  fi
}
tree() { # NAME FILE TEXT: a fresh tree holding one good file and FILE
  rm -rf "${work:?}/$1"
  mkdir -p "$work/$1/rt_core" "$work/$1/$(dirname "$2")"
  cp "$gates/../../.clang-format" "$work/$1/"
  printf '#include "rt_core/base.h"\n' >"$work/$1/rt_core/good.cpp"
  printf '%b' "$3" >"$work/$1/$2"
}
source_gate() { # pass|fail GATE FILE TEXT
  tree sample "$3" "$4"
  expect "$1" "$2 on $3 ($4)" "$gates/$2.sh" "$work/sample"
}

source_gate pass include_direction rt_core/a.cpp '#include <cstdint>\n#include <ccd/ccd.h>\n#include "rt_core/base.h"\n'
source_gate fail include_direction rt_core/a.cpp '#include <vector>\n'
source_gate fail include_direction rt_core/a.h '#include <ccd/ccd.h>\n'
source_gate fail include_direction rt_core/a.cpp '#include <Eigen/Core>\n'
source_gate fail include_direction rt_core/a.cpp '#include "hal/loop/loop.h"\n'
source_gate fail include_direction hal/a.cpp '#include "config/scene/scene.h"\n'
source_gate fail include_direction hal/a.cpp '#include <config/scene/scene.h>\n'
source_gate fail include_direction config/a.cpp '  #  include "hal/loop/loop.h"\n'
source_gate fail include_direction config/a.cpp '#include "sim_host/cli.h"\n'
source_gate pass include_direction sim_host/a.cpp '#include "config/scene/scene.h"\n#include "hal/loop/loop.h"\n'

long=$(printf 'int x;\\n%.0s' $(seq 501))
source_gate fail file_size rt_core/a.cpp "$long"
source_gate pass file_size rt_core/a.cpp 'int x;\n'

if command -v clang-format-14 >/dev/null; then
  source_gate fail format hal/a.cpp 'int  x ;\n'
  source_gate pass format hal/a.cpp 'int x;\n'
fi

source_gate pass words rt_core/a.cpp '// old normal to new normal; free of malloc\nint x; /* throw */\nconst char* t = "new";\nA(A&) = delete;\n'
source_gate fail words rt_core/a.cpp 'int* x = new int;\n'
source_gate fail words rt_core/a.h 'std::vector<int> x;\n'
source_gate fail words rt_core/a.cpp 'double y = std::sin(x);\n'
source_gate fail words rt_core/a.cpp 'void f() { while (true) {} }\n'
source_gate pass words config/a.cpp 'std::vector<int> x;\n'
source_gate fail words config/a.cpp "// TO""DO: later\n"
source_gate fail words tests/a.cpp "GTEST_""SKIP();\n"
source_gate fail words docs/a.md "see /wo""rk/main/run\n"
source_gate fail words docs/a.md "see ../sha""red/notes\n"

source_gate pass links docs/a.md '[a](a.md) [b](https://example.org/x.md) [c](a.md#part)\n'
source_gate fail links docs/a.md '[a](missing.md)\n'
source_gate fail links rt_core/a.cpp '// see docs/missing.md\n'

documented() { # FAULTS.MD ROW, SECURITY.MD ROW, EXIT_CODES.MD ROW: a tree with one test, one fault, one verdict
  tree sample tests/hal/a.cpp 'TEST(Silence, Latches) { run("0.8 silence 1"); EXPECT(Fault::kSilent); }\n'
  mkdir -p "$work/sample/docs" "$work/sample/hal" "$work/sample/sim_host/run"
  printf '#define PALPATE_FAULT_BITS(X) X(kSilent, 1)\n\n' >"$work/sample/rt_core/status.h"
  printf 'raise(Fault::kSilent);\n' >"$work/sample/hal/b.cpp"
  printf '{"stale", share(a, b)}\n' >"$work/sample/sim_host/run/verdict.cpp"
  printf '%s\n' "$1" >"$work/sample/docs/faults.md"
  printf '| attack | answer | test |\n|---|---|---|\n%s\n\n' "$2" >"$work/sample/docs/security.md"
  printf '%s\n' "$3" >"$work/sample/docs/exit_codes.md"
}
fault_row='| cable out (`silence 1`) | `kSilent` |' attack_row='| silence | a fault | `Silence.Latches` |' verdict_row='| `stale` | 1 % |'
documented "$fault_row" "$attack_row" "$verdict_row"
expect pass "doc_tests on documents that agree" "$gates/doc_tests.sh" "$work/sample"
documented "$fault_row" '| silence | a fault | `Silence.Lasts` |' "$verdict_row"
expect fail "doc_tests on a test that does not exist" "$gates/doc_tests.sh" "$work/sample"
documented "$fault_row" '| silence | a fault | none |' "$verdict_row"
expect fail "doc_tests on an attack without a test" "$gates/doc_tests.sh" "$work/sample"
documented '| cable out (`deaf 2`) | `kSilent` |' "$attack_row" "$verdict_row"
expect fail "doc_tests on a script nobody plays" "$gates/doc_tests.sh" "$work/sample"
documented '| cable out (`silence 1`) | a fault |' "$attack_row" "$verdict_row"
expect fail "doc_tests on a fault nobody explains" "$gates/doc_tests.sh" "$work/sample"
documented "$fault_row" "$attack_row" ''
expect fail "doc_tests on a verdict nobody explains" "$gates/doc_tests.sh" "$work/sample"

figures() { # DAY MEASURED, DAY OF THE CODE, COMMAND IN THE README: a checkout with one figure
  rm -rf "$work/figures"
  mkdir -p "$work/figures/rt_core" "$work/figures/tests/bench"
  printf '| what it guarantees | measured | by |\n|---|---|---|\n| fast | 3 us | `%s` |\n\n' "$3" >"$work/figures/README.md"
  printf '3 us | %s | ./run bench | rt_core\n' "$1" >"$work/figures/tests/bench/figures.txt"
  printf 'int x;\n' >"$work/figures/rt_core/a.cpp"
  (cd "$work/figures" && git init -q && git add -A &&
    GIT_COMMITTER_DATE="$2T12:00:00" git -c user.name=gate -c user.email=gate@example.org commit -q -m figures)
}
figures 2026-01-02 2026-01-01 './run bench'
expect pass "figures on a figure younger than its code" "$gates/../bench/figures.sh" "$work/figures"
figures 2026-01-01 2026-01-02 './run bench'
expect fail "figures on a figure older than its code" "$gates/../bench/figures.sh" "$work/figures"
figures 2026-01-02 2026-01-01 'a stopwatch'
expect fail "figures on a figure without its command" "$gates/../bench/figures.sh" "$work/figures"
figures 2026-01-02 2026-01-01 './run bench'
printf 'int y;\n' >"$work/figures/rt_core/a.cpp"
expect fail "figures on code changed since" "$gates/../bench/figures.sh" "$work/figures"

unit="$gates/../../hal/system/palpate@.service"
expect pass "unit_security on the service" "$gates/unit_security.sh" "$unit"
sed 's/^NoNewPrivileges=yes/NoNewPrivileges=no/' "$unit" >"$work/palpate@.service"
expect fail "unit_security on a service that may gain rights" "$gates/unit_security.sh" "$work/palpate@.service"
grep -v '^User=' "$unit" >"$work/palpate@.service"
expect fail "unit_security on a service of root" "$gates/unit_security.sh" "$work/palpate@.service"
sed 's/ --profile [^ ]*//' "$unit" >"$work/palpate@.service"
expect fail "unit_security on a service without a device profile" "$gates/unit_security.sh" "$work/palpate@.service"

compile() { "$compiler" -std=c++20 -O1 -fPIC "$@"; }
archive() { # NAME TEXT
  printf '%b' "$2" >"$work/$1.cpp"
  compile -c "$work/$1.cpp" -o "$work/$1.o"
  rm -f "$work/$1.a"
  ar rc "$work/$1.a" "$work/$1.o"
}
archive clean 'int f(int x) { return x + 1; }\n'
expect pass "symbols_core on clean code" "$gates/symbols_core.sh" "$work/clean.a"
archive allocates 'int* f() { return new int(3); }\n'
expect fail "symbols_core on operator new" "$gates/symbols_core.sh" "$work/allocates.a"
archive throws 'void f() { throw 1; }\n'
expect fail "symbols_core on throw" "$gates/symbols_core.sh" "$work/throws.a"
archive libm 'extern "C" double pow(double, double); double f(double x) { return pow(x, 0.3); }\n'
expect fail "symbols_core on pow" "$gates/symbols_core.sh" "$work/libm.a"
archive penetrates 'extern "C" int ccdGJKPenetration(); int f() { return ccdGJKPenetration(); }\n'
expect fail "symbols_core on ccdGJKPenetration" "$gates/symbols_core.sh" "$work/penetrates.a"

expect pass "instructions_core on clean code" "$gates/instructions_core.sh" "$work/clean.a"
archive fused '__attribute__((target("fma"))) double f(double a, double b, double c) { return __builtin_fma(a, b, c); }\n'
expect fail "instructions_core on a fused multiply-add" "$gates/instructions_core.sh" "$work/fused.a"
archive gather 'void f() { __asm__("vgatherdps %%ymm1,(%%rsi,%%ymm4,4),%%ymm3" : : : "memory"); }\n'
expect fail "instructions_core on a gather that QEMU gets wrong" "$gates/instructions_core.sh" "$work/gather.a" laboratory
expect pass "instructions_core on the same gather in what is shipped" "$gates/instructions_core.sh" "$work/gather.a"
if command -v aarch64-linux-gnu-g++ >/dev/null; then
  arm_gate() { # pass|fail TEXT
    printf '%b' "$2" >"$work/arm.cpp"
    aarch64-linux-gnu-g++ -O2 -ffp-contract=off -c "$work/arm.cpp" -o "$work/arm.o"
    expect "$1" "instructions_core on AArch64 ($2)" env OBJDUMP=aarch64-linux-gnu-objdump "$gates/instructions_core.sh" "$work/arm.o"
  }
  arm_gate pass 'double f(double a, double b, double c) { return a * b + c; }\n'
  arm_gate fail 'double f(double a, double b, double c) { return __builtin_fma(a, b, c); }\n'
  arm_gate fail 'double f(double a, double b, double c) { return -__builtin_fma(a, b, c); }\n'
fi

counted_on_arm() { # pass|fail NAME COUNTS
  printf '%b' "$3" >"$work/counts"
  printf '# limits\nring 100\nsnap_in 200\n' >"$work/budgets"
  expect "$1" "AArch64's budgets on $2" "$gates/../aarch64/tick_count.sh" judge "$work/counts" "$work/budgets"
}
ring='ring worst tick 100 instructions (tick 7)\n' snap='snap_in worst tick 150 instructions (tick 7)\n'
counted_on_arm pass "two scenes within" "$ring$snap"
counted_on_arm fail "a scene over its budget" "${ring/100/101}$snap"
counted_on_arm fail "a scene without a budget" "$ring${snap}half_shell worst tick 5 instructions\n"
counted_on_arm fail "a scene that was not counted" "$ring"
counted_on_arm fail "a program that did not run" "$ring${snap}snap_in no such file\n"
counted_on_arm fail "nothing" ''

stages_counted() { # pass|fail NAME CALLER: a tick of two stages, one of which CALLER calls
  cat >"$work/counts" <<COUNTS
part: 1
desc: Trigger: Client Request: tick 0 contacts 1 regions 1
fn=(below main)
cfn=palpate::tick(palpate::Model const&)
calls=1 0
1 300
fn=palpate::tick(palpate::Model const&)
cfn=palpate::sense(palpate::Model const&)
calls=1 0
1 100
fn=$3
cfn=palpate::publish(palpate::State&)
calls=1 0
1 200
COUNTS
  expect "$1" "stages of a tick, $2" awk -v functions="sense publish" -f "$gates/../bench/worst_tick.awk" "$work/counts"
}
stages_counted pass "called from where they are" 'palpate::(anonymous namespace)::render(palpate::Model const&)'
stages_counted fail "called from elsewhere" 'palpate::(anonymous namespace)::play(palpate::Model const&)'

program() { # NAME TEXT LIBRARY...
  local name=$1
  printf '%b' "$2" >"$work/$name.cpp"
  shift 2
  compile "$work/$name.cpp" -o "$work/$name" -Wl,--no-as-needed "$@"
}
program overlap 'extern "C" int ccdGJKIntersect(); int main(int n, char**) { return n > 9 ? ccdGJKIntersect() : 0; }\n' -lccd
expect pass "symbols_controller on ccdGJKIntersect" "$gates/symbols_controller.sh" "$work/overlap"
program penetration 'extern "C" int ccdMPRPenetration(); int main(int n, char**) { return n > 9 ? ccdMPRPenetration() : 0; }\n' -lccd
expect fail "symbols_controller on ccdMPRPenetration" "$gates/symbols_controller.sh" "$work/penetration"
program pictures 'int main() { return 0; }\n' -lpng
expect fail "symbols_controller on libpng" "$gates/symbols_controller.sh" "$work/pictures"

[ "$failures" -eq 0 ] || { echo "gate self-test: $failures of $cases cases wrong"; exit 1; }
echo "gate self-test: $cases cases, every gate fires and none fires on good code"
