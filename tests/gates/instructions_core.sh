#!/usr/bin/env bash
# Gate: no fused multiply-add and no x87 arithmetic in the real-time core: both round differently from what is written, so
# one compiler's bits would differ from another's. With `laboratory`, for a program of its own: no gather indexed by xmm4 or
# ymm4, which QEMU gets wrong (rt_core/CMakeLists.txt). Usage: instructions_core.sh ARCHIVE | PROGRAM laboratory
# OBJDUMP: the disassembler, where the archive is for another processor.
set -euo pipefail
archive=${1:?usage: instructions_core.sh ARCHIVE | PROGRAM laboratory}
listing=$("${OBJDUMP:-objdump}" -d --no-show-raw-insn -C "$archive")
[ -n "$listing" ] || { echo "$archive holds no code"; exit 1; }
if [ "${2:-}" = laboratory ]; then
  found=$(awk '
    /^[0-9a-f]+ <.*>:$/ { name = $0; sub(/^[0-9a-f]+ /, "", name) }
    $2 ~ /^vp?gather/ && $3 ~ /,%[xy]mm4,[1248]\)/ { print name, $2, $3 }' <<<"$listing")
  [ -z "$found" ] || { echo "gathers that the laboratory's processor gets wrong:"; echo "$found"; exit 1; }
  echo "laboratory: $(grep -cE '	vp?gather' <<<"$listing") gathers looked at in $(basename "$archive"), all right"
  exit
fi
found=$(awk '
  /:[ \t]+file format/ { object = $1 }
  /^[0-9a-f]+ <.*>:$/ { name = $0; sub(/^[0-9a-f]+ /, "", name) }
  /file format elf64-littleaarch64/ { arm = 1 }
  arm && $2 ~ /^f(n?madd|n?msub|ml[as]|cmla)/ { print object, name, $2 }
  !arm && $2 ~ /^(vfn?m(add|sub)|fadd|fsub|fmul|fdiv|fsqrt|fld|fild)/ { print object, name, $2 }' <<<"$listing")
[ -z "$found" ] || { echo "instructions that round differently from the source:"; echo "$found"; exit 1; }
echo "core instructions: $(grep -c ':	' <<<"$listing") looked at, none fused"
