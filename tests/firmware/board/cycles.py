#!/usr/bin/env python3
"""Cycles of a Cortex-M4 in each call of one function, from an emulator's trace of every instruction and the
disassembly: Arm's table (Cortex-M4 Technical Reference Manual, DDI 0439, tables 3-1 and 7-1), each entry at its worst:
a branch that is taken refills the pipeline in 3, a load stalls what follows, a result of the FPU is waited for. Memory
without wait states.

Usage: cycles.py DISASSEMBLY TRACE FUNCTION    prints calls, and the most instructions and cycles of one
"""

import re
import sys

REFILL = 3
FIXED = {"vdiv": 14, "vsqrt": 14, "vmla": 4, "vmls": 4, "vfma": 4, "vfms": 4, "vnmla": 4, "vnmls": 4, "udiv": 12,
         "sdiv": 12, "mla": 2, "mls": 2, "smlal": 2, "umlal": 2, "ldrd": 3, "strd": 3, "dsb": 4, "isb": 4}


def registers(operands):
    """How many a list in braces names."""
    inside = operands[operands.index("{") + 1:operands.index("}")]
    count = 0
    for part in inside.split(","):
        ends = [int(number) for number in re.findall(r"[rsd](\d+)", part)]
        words = 2 if part.strip().startswith("d") else 1
        count += words * (ends[-1] - ends[0] + 1 if len(ends) == 2 else 1)
    return count


def cost(mnemonic, operands):
    """Cycles without the refill of a branch."""
    name = mnemonic.split(".")[0]
    for stem in (name, name[:-2]):  # with and without a condition
        if stem in FIXED:
            return FIXED[stem]
    if "{" in operands:
        return 1 + registers(operands)
    if name.startswith(("vldr", "vstr")):
        return 3 if "d" in operands.split(",")[0] else 2
    if name.startswith(("ldr", "str")):
        return 2
    return 2 if name.startswith("v") else 1


def read_code(path):
    """Address: (size, cycles, mnemonic); function: address."""
    code, functions = {}, {}
    with open(path, encoding="ascii") as file:
        for line in file:
            if head := re.match(r"([0-9a-f]{8}) <(\w+)>:", line):
                functions[head[2]] = int(head[1], 16)
            elif row := re.match(r" +([0-9a-f]+):\t([0-9a-f ]+)\t(\S+)(?:\t(.*))?", line):
                size = len(row[2].replace(" ", "")) // 2
                code[int(row[1], 16)] = (size, cost(row[3], row[4] or ""), row[3])
    return code, functions


def main(disassembly, trace, function):
    code, functions = read_code(disassembly)
    entry, calls, most = functions[function], 0, (0, 0)
    inside, came_from, instructions, cycles, back = False, 0, 0, 0, 0
    with open(trace, encoding="ascii", errors="replace") as file:
        for line in file:
            row = re.match(r"Trace \d+: \S+ \[[0-9a-f]+/([0-9a-f]+)/", line)
            if not row:
                continue
            at = int(row[1], 16)
            size, needed, _ = code.get(at, (0, 0, ""))
            if size == 0:
                sys.exit(f"cycles.py: {at:#x} is in the trace and not in the disassembly")
            if inside and at != came_from + code[came_from][0]:
                cycles += REFILL
            if inside and at == back:
                calls += 1
                most = max(most, (cycles, instructions))
                inside = False
            if at == entry:
                inside, instructions, cycles = True, 0, REFILL
                back = came_from + code[came_from][0]
            if inside:
                instructions += 1
                cycles += needed
            came_from = at
    if calls == 0:
        sys.exit(f"cycles.py: {function} was never called and left in {trace}")
    print(f"{calls} {most[1]} {most[0]}")


if __name__ == "__main__":
    main(*sys.argv[1:4])
