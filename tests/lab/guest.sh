#!/usr/bin/env bash
# Builds the laboratory's guest: Debian's PREEMPT_RT kernel and an initramfs with the given programs, tools and scenes.
# Nothing is installed on this machine: packages are downloaded and unpacked, and kept in CACHE for the next time.
#   guest.sh CACHE OUT PROGRAM... -- FILE...     (FILEs are copied to /lab in the guest)
set -euo pipefail
cache=$(mkdir -p "$1" && cd "$1" && pwd) out=$(mkdir -p "$2" && cd "$2" && pwd)
shift 2
here=$(cd "$(dirname "$0")" && pwd)
modules="can can-raw can-dev vcan sja1000 kvaser_pci usb-common usbcore udc-core dummy_hcd configfs libcomposite hid usbhid
         hid-generic usb_f_hid usb_f_fs virtio_pci virtio_blk qemu_fw_cfg"
tools="rt-tests can-utils libnuma1"

say() { printf 'lab: %s\n' "$*" >&2; }

fetch() {  # kernel and tools, once
  [ -e "$cache/complete" ] && return
  say "downloading the PREEMPT_RT kernel and tools (once, about 70 MB)"
  image=$(apt-cache depends linux-image-rt-amd64 | awk '/Depends: linux-image/{print $2; exit}')
  [ -n "$image" ] || { say "no PREEMPT_RT kernel is cached in $cache and no package linux-image-rt-amd64 is known: run apt-get update"; exit 3; }
  # shellcheck disable=SC2086
  (cd "$cache" && apt-get download -qq "$image" $tools 2>/dev/null) || {
    say "no PREEMPT_RT kernel is cached in $cache, and these packages cannot be downloaded: $image $tools. Is the network up?"
    exit 3
  }
  for package in "$cache"/*.deb; do dpkg -x "$package" "$cache/x"; done
  version=$(basename "$cache"/x/lib/modules/*)
  /sbin/depmod -b "$cache/x" "$version"
  touch "$cache/complete"
}

copy_program() {  # with its shared libraries, at the paths the loader expects
  local program=$1 target=$2
  cp "$program" "$target"
  { LD_LIBRARY_PATH=$cache/x/usr/lib/x86_64-linux-gnu ldd "$program" 2>/dev/null || true; } |  # fails for a static one
    awk '/=> \//{print $3} /^\t\/lib64/{print $1}' | while read -r library; do
      at=$out/root${library#"$cache/x"}
      mkdir -p "$(dirname "$at")"
      [ -e "$at" ] || cp -L "$library" "$at"
    done
}

pack() {
  local version module path
  version=$(basename "$cache"/x/lib/modules/*)
  rm -rf "$out/root"
  mkdir -p "$out/root"/{bin,mod,proc,sys,dev,lab,tmp,lib64,lib/x86_64-linux-gnu,usr/lib/x86_64-linux-gnu}
  cp /bin/busybox "$out/root/bin/busybox"
  copy_program /sbin/ip "$out/root/bin/ip.real"
  copy_program "$(command -v chrt)" "$out/root/bin/chrt"
  for tool in cyclictest candump cangen cansend canplayer; do copy_program "$cache/x/usr/bin/$tool" "$out/root/bin/$tool"; done
  : > "$out/root/mod/order"
  for module in $modules; do
    /sbin/modprobe -d "$cache/x" -S "$version" --show-depends "$module" | awk '/^insmod/{print $2}'
  done | awk '!seen[$0]++' | while read -r path; do
    cp "$path" "$out/root/mod/"
    basename "$path" >> "$out/root/mod/order"
  done
  while [ $# -gt 0 ] && [ "$1" != "--" ]; do copy_program "$1" "$out/root/bin/$(basename "$1")"; shift; done
  [ $# -eq 0 ] || shift
  for file in "$@"; do cp -r "$file" "$out/root/lab/"; done
  cp "$here/guest_init" "$out/root/init"
  chmod +x "$out/root/init"
  (cd "$out/root" && find . | LC_ALL=C sort | cpio -o -H newc --reproducible 2>/dev/null | gzip -1 > ../initrd.gz)
  cp "$cache"/x/boot/vmlinuz-* "$out/vmlinuz"
}

fetch
pack "$@"
