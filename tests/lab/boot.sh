#!/usr/bin/env bash
# Boots the guest in deterministic virtual time.
#   boot.sh save OUT                                          boots once and keeps the machine, ready, in OUT/machine
#   boot.sh run OUT SCENARIO SECONDS RESULT_DIR [LIMIT_S]     runs a scenario on the kept machine, unpacks its results
# LIMIT_S: of processor time, which a busy host does not change.
# The machine is pinned: any change to it shifts latencies by a few microseconds.
set -euo pipefail
mode=$1 out=$2 order='wait' scenario='' results=$2
if [ "$mode" = run ]; then
  scenario=$3 results=$5
  order="run $3 $4 "
fi
mkdir -p "$results"
disk=$results/disk.img
rm -f "$disk"
truncate -s 256M "$disk"
trap 'rm -f "$disk"' EXIT

# The order's length is part of the machine: the guest asks for it once.
machine=(-nodefaults -display none -no-reboot -m 1024 -smp 1 -accel tcg -cpu max -icount 'shift=0,sleep=off' -seed 1
  -rtc 'base=2024-01-01,clock=vm' -kernel "$out/vmlinuz" -initrd "$out/initrd.gz"
  -append "console=ttyS0 quiet nokaslr norandmaps random.trust_cpu=off panic=-1"
  -object 'can-bus,id=bus0' -device 'kvaser_pci,canbus=bus0' -device 'kvaser_pci,canbus=bus0'
  -drive "file=$disk,if=virtio,format=raw,cache=unsafe" -serial "file:$results/console.txt"
  -fw_cfg "name=opt/palpate,string=$(printf '%-64s' "$order")")

save() {
  local monitor
  rm -f "$out/machine" "$out/monitor"
  : > "$results/console.txt"
  mkfifo "$out/monitor"
  (
    ulimit -t 300
    exec timeout 3600 qemu-system-x86_64 "${machine[@]}" -monitor stdio < "$out/monitor" > "$out/monitor.txt" 2>&1
  ) &
  exec {monitor}> "$out/monitor"
  until grep -q '^lab: ready' "$results/console.txt"; do
    sleep 0.2
    if ! kill -0 $! 2> /dev/null; then
      echo "lab: the guest did not boot within 300 s of processor time:" >&2
      tail -n 5 "$results/console.txt" "$out/monitor.txt" >&2
      return 1
    fi
  done
  printf 'migrate "exec:cat > %s"\nquit\n' "$out/machine" >&"$monitor"
  wait $!
  [ -s "$out/machine" ]
}

run() {
  local status=0
  (
    ulimit -t "$1"
    exec qemu-system-x86_64 "${machine[@]}" -monitor none -incoming "exec:cat '$out/machine'" < /dev/null
  ) > "$results/qemu.txt" 2>&1 || status=$?
  if [ $status -ne 0 ]; then
    echo "lab: $scenario: the guest did not end by itself within $1 s of processor time (status $status); see $results/console.txt" >&2
    return 1
  fi
  tar xf "$disk" -C "$results" 2> /dev/null || true
  [ "$(cat "$results/exit_code" 2> /dev/null || echo 1)" = 0 ]
}

if [ "$mode" = save ]; then save; else run "${6:-600}"; fi
