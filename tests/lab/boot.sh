#!/usr/bin/env bash
# Boots the guest in OUT with one scenario in deterministic virtual time and unpacks its results.
#   boot.sh OUT SCENARIO SECONDS RESULT_DIR [TIMEOUT_S]
# The command line is pinned: any change to it shifts latencies by a few microseconds.
set -euo pipefail
out=$1 scenario=$2 seconds=$3 results=$4 timeout_s=${5:-600}
mkdir -p "$results"
disk=$results/disk.img
rm -f "$disk"
truncate -s 256M "$disk"
status=0
timeout "$timeout_s" qemu-system-x86_64 -nodefaults -display none -serial stdio -no-reboot -m 1024 -smp 1 \
  -accel tcg -cpu max -icount shift=0,sleep=off -seed 1 -rtc base=2024-01-01,clock=vm \
  -kernel "$out/vmlinuz" -initrd "$out/initrd.gz" \
  -append "console=ttyS0 quiet nokaslr norandmaps random.trust_cpu=off panic=-1 scenario=$scenario seconds=$seconds" \
  -object can-bus,id=bus0 -device kvaser_pci,canbus=bus0 -device kvaser_pci,canbus=bus0 \
  -drive "file=$disk,if=virtio,format=raw,cache=unsafe" < /dev/null > "$results/console.txt" 2>&1 || status=$?
if [ $status -ne 0 ]; then
  echo "lab: $scenario: the guest did not end by itself within $timeout_s s (status $status); see $results/console.txt" >&2
  exit 1
fi
tar xf "$disk" -C "$results" 2>/dev/null || true
rm -f "$disk"
[ "$(cat "$results/exit_code" 2>/dev/null || echo 1)" = 0 ]
