#!/usr/bin/env bash
# Boots Debian's PREEMPT_RT kernel for AArch64 in virtual time, as ./run lab does for x86-64, and renders one scene in it:
# the cross-built controller and simulated device on vcan, CAN FD. Nothing is installed: packages are downloaded and
# unpacked into CACHE, once. Usage: laboratory.sh AARCH64_BUILD_DIR IMAGE.pal HAND.csv CACHE RESULTS [SECONDS]
set -euo pipefail
usage='usage: laboratory.sh AARCH64_BUILD_DIR IMAGE.pal HAND.csv CACHE RESULTS [SECONDS]'
build=${1:?$usage} image=${2:?$usage} hand=${3:?$usage}
cache=$(mkdir -p "${4:?$usage}" && cd "$4" && pwd) results=$(mkdir -p "${5:?$usage}" && cd "$5" && pwd) seconds=${6:-10}
here=$(cd "$(dirname "$0")" && pwd)
modules='can can-raw can-dev vcan'
tools='busybox-static rt-tests can-utils libnuma1'

say() { printf 'lab: %s\n' "$*" >&2; }

fetch() { # package lists of its own: the machine's dpkg need not know a second processor
  [ ! -e "$cache/complete" ] || return 0
  local apt=$cache/apt kernel version
  say "downloading the PREEMPT_RT kernel for AArch64 (once, 60 MB)"
  rm -rf "${cache:?}"/* && mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial" "$apt/packages"
  : > "$apt/status"
  printf '%s\n' 'APT::Architecture "arm64";' 'APT::Architectures { "arm64"; };' "APT::Sandbox::User \"$(id -un)\";" \
    "Dir::State \"$apt\";" "Dir::State::status \"$apt/status\";" "Dir::Cache \"$apt/cache\";" > "$apt/settings"
  export APT_CONFIG=$apt/settings
  apt-get update -qq || say "not every package list could be read"
  kernel=$(apt-cache depends linux-image-rt-arm64 | awk '/Depends: linux-image/ { print $2; exit }')
  # shellcheck disable=SC2086  # a list of words
  (cd "$apt/packages" && apt-get download -qq "${kernel:?no package linux-image-rt-arm64 is known}" $tools) ||
    { say "packages cannot be downloaded for arm64: $kernel $tools. Is the network up?"; exit 3; }
  for package in "$apt"/packages/*.deb; do dpkg -x "$package" "$cache/x"; done
  rm -rf "$apt"
  version=$(basename "$cache"/x/lib/modules/*)
  /sbin/depmod -b "$cache/x" "$version"
  touch "$cache/complete"
}

copy_program() { # PROGRAM TARGET, with its shared libraries in one folder
  local file
  cp "$1" "$2"
  "$here/emulator.sh" -E LD_TRACE_LOADED_OBJECTS=1 "$1" |
    awk '{ for (i = 1; i <= NF; i++) if ($i ~ /^\//) print $i }' | while read -r file; do
      [ -e "$file" ] || file=/usr/aarch64-linux-gnu$file
      cp -nL "$file" "$work/root/lib/"
    done
}

pack() { # the guest's root
  local version module path
  version=$(basename "$cache"/x/lib/modules/*)
  mkdir -p "$work/root"/{bin,lib,mod,proc,sys,dev,lab,tmp}
  cp "$cache/x/bin/busybox" "$work/root/bin/busybox"
  cp "$cache"/x/usr/lib/aarch64-linux-gnu/libnuma.so.1.* "$work/root/lib/libnuma.so.1"
  copy_program "$build/bin/palpate-rt" "$work/root/bin/palpate-rt"
  copy_program "$build/bin/palpate-device" "$work/root/bin/palpate-device"
  copy_program "$cache/x/usr/bin/cyclictest" "$work/root/bin/cyclictest"
  copy_program "$cache/x/usr/bin/candump" "$work/root/bin/candump"
  for module in $modules; do
    /sbin/modprobe -d "$cache/x" -S "$version" --show-depends "$module" | awk '/^insmod/ { print $2 }'
  done | awk '!seen[$0]++' | while read -r path; do
    cp "$path" "$work/root/mod/"
    basename "$path" >> "$work/root/mod/order"
  done
  cp "$image" "$work/root/lab/scene.pal"
  cp "$here/../../config/devices/sim-6dof.toml" "$work/root/lab/"
  # The hand waits outside the body until the controller is armed.
  awk -F, -v seconds="$seconds" 'NR == 1 { print; next } { row[n++] = $0; split($0, f, ","); last = f[1] + 1 }
    function at(i, t) { split(row[i], f, ","); print f[1] + t substr(row[i], index(row[i], ",")) }
    END { at(0, 0); for (t = 3; t < seconds + 4; t += last) for (i = 0; i < n; i++) at(i, t) }' "$hand" > "$work/root/lab/hand.csv"
  cp "$here/guest_init" "$work/root/init"
  chmod +x "$work/root/init"
  (cd "$work/root" && find . | LC_ALL=C sort | cpio -o -H newc --reproducible 2> /dev/null | gzip -1 > ../initrd.gz)
}

# One instruction is one nanosecond, time at rest is skipped: what is measured does not depend on the machine.
boot() {
  timeout 1500 qemu-system-aarch64 -M virt,gic-version=3 -cpu cortex-a76 -smp 1 -m 1024 -accel tcg -icount shift=0,sleep=off -seed 1 \
    -rtc base=2024-01-01,clock=vm -nodefaults -display none -no-reboot -monitor none -kernel "$cache"/x/boot/vmlinuz-* \
    -initrd "$work/initrd.gz" -append "console=ttyAMA0 quiet nokaslr norandmaps panic=-1 palpate.seconds=$seconds" \
    -serial "file:$results/console.txt" < /dev/null
}

number() { tr -d '\r' < "$results/console.txt" | awk "$1"; } # AWK: of the guest's words

# The largest component of force in the commands that were on the bus with the motors on, mN; three signed 16-bit numbers,
# the low byte first.
force() {
  local most=0 line axis value
  while read -r line; do
    for axis in 0 4 8; do
      value=$((16#${line:axis+2:2}${line:axis:2}))
      [ $value -lt 32768 ] || value=$((65536 - value))
      [ $value -le $most ] || most=$value
    done
  done < <(number '/^force / { print $2 }')
  echo $most
}

judge() {
  local missed ticks faults kernel most_mN
  most_mN=$(force)
  missed=$(number '/^controller: .* missed/ { print $4 }') ticks=$(number '/^controller: .* ticks/ { print $2 }')
  faults=$(number '/^loop thread:/ { print $3 + $6 }') kernel=$(number '/^# Max Latencies/ { print $4 + 0 }')
  printf '%s ticks  missed %s  page faults %s  cyclictest max %s us  force up to %s mN  %s\n' "${ticks:--}" "${missed:--}" "${faults:--}" \
    "${kernel:--}" "$most_mN" "$(number '/PREEMPT_RT=/ { print $2, $3 }')"
  number '/^controller: |^loop thread:|^device clock/'
  [ "$missed" = 0 ] && [ "$faults" = 0 ] && [ "${ticks:-0}" -ge $((900 * seconds)) ] && [ "$most_mN" -gt 500 ] &&
    number '/^controller: .* faults 0x0$/ { good = 1 } END { exit !good }'
}

for tool in qemu-system-aarch64 cpio; do
  command -v $tool > /dev/null || { say "$tool is missing: apt-get install qemu-system-arm cpio"; exit 3; }
done
fetch
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
pack
say "booting, and rendering $seconds s"
rm -f "$results/console.txt"
boot || say "the guest did not end by itself; see $results/console.txt"
judge
