#!/usr/bin/env bash
# The firmware's node on an emulated Cortex-M4 (qemu's mps2-an386): it fits 64 KiB of flash and 16 KiB of RAM, computes the
# same bits as on this computer, and its longest step of control takes so many cycles. Usage: board.sh ROOT
set -euo pipefail
root=$(cd "${1:?usage: board.sh ROOT}" && pwd)
steps=20000 traced=1500
# The longest step may take half of a period at 10 kHz and 168 MHz, a common Cortex-M4; the other half is the board's.
most_cycles=8400
# What Arm's start-up files give a program by default (Stack_Size 0x400), and the controller's whole RAM.
most_stack=1024 most_ram=16384
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for program in arm-none-eabi-gcc qemu-system-arm; do
  command -v $program >/dev/null || { echo "$program is missing: apt-get install gcc-arm-none-eabi qemu-system-arm"; exit 1; }
done
here=$root/tests/firmware/board
sources=("$root/hal/firmware/haptic_node.c" "$here/exercise.c")
flags=(-std=c11 -O2 -ffp-contract=off -fno-math-errno -I"$root" -Wall -Wextra -Werror)

build() { # STEPS ELF
  arm-none-eabi-gcc "${flags[@]}" -ffreestanding -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard \
    -ffunction-sections -fdata-sections -DSTEPS="$1" -nostdlib -T "$here/cortex_m4.ld" -Wl,--gc-sections \
    "${sources[@]}" "$here/cortex_m4.c" -lgcc -o "$2"
}
emulate() { # ELF [OPTION...]
  timeout 300 qemu-system-arm -M mps2-an386 -nographic -monitor none -serial none -semihosting-config enable=on,target=native \
    -kernel "$@" 2>&1
}

gcc "${flags[@]}" "${sources[@]}" "$here/host.c" -lm -o "$work/host"
build "$steps" "$work/board.elf"
mapfile -t said < <(emulate "$work/board.elf")
expected=$("$work/host" "$steps")
[ "${said[0]:-none}" = "$expected" ] || { echo "the board's hash is ${said[*]:-none}, this computer's $expected"; exit 1; }
stack=$((16#${said[1]}))

read -r text data bss < <(arm-none-eabi-size "$work/board.elf" | awk 'NR == 2 { print $1, $2, $3 }')
build "$traced" "$work/traced.elf"
emulate "$work/traced.elf" -singlestep -d exec,nochain -D "$work/trace" >/dev/null
arm-none-eabi-objdump -d "$work/traced.elf" >"$work/code"
read -r calls instructions cycles < <(python3 "$here/cycles.py" "$work/code" "$work/trace" measured_step)
echo "same bits as here in $steps steps: $expected"
echo "flash $((text + data)) bytes, RAM $((data + bss)) bytes and $stack of stack, the exercise included"
echo "longest of $calls steps (a command, its model, control and a status): $instructions instructions, at most $cycles cycles"
[ "$stack" -gt 0 ] && [ "$stack" -le "$most_stack" ] || { echo "$stack bytes of stack: allowed are 1 to $most_stack"; exit 1; }
[ $((data + bss + stack)) -le "$most_ram" ] || { echo "more than $most_ram bytes of RAM with the stack"; exit 1; }
[ "$cycles" -le "$most_cycles" ] || { echo "more than $most_cycles cycles, half of a period of 10 kHz at 168 MHz"; exit 1; }
