#!/usr/bin/env bash
# The Debian packages: made of what is built, complete, without a trace of the machine that built them; what they hold runs from
# where they put it. Usage: packages.sh CPACK BUILD_DIR ROOT viewer 0|1 python 0|1
set -euo pipefail
usage="usage: packages.sh CPACK BUILD_DIR ROOT viewer 0|1 python 0|1"
cpack=${1:?$usage} build=${2:?$usage} root=${3:?$usage} viewer=${5:?$usage} python=${7:?$usage}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
problems=0
wrong() { echo "$*"; problems=$((problems + 1)); }

(cd "$build" && "$cpack" -G DEB -B "$work") >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
expected='libpalpate-dev palpate'
[ "$viewer" = 0 ] || expected+=' palpate-viewer'
[ "$python" = 0 ] || expected+=' python3-palpate'
made=$(for deb in "$work"/*.deb; do dpkg-deb -f "$deb" Package; done | LC_ALL=C sort | tr '\n' ' ')
[ "$made" = "$expected " ] || wrong "packages: $made, not $expected"

for deb in "$work"/*.deb; do
  dpkg-deb -x "$deb" "$work/root"
  name=$(dpkg-deb -f "$deb" Package)
  [ -s "$work/root/usr/share/doc/$name/copyright" ] || wrong "$name has no copyright file"
  [[ $(dpkg-deb -f "$deb" Description | wc -c) -gt 40 ]] || wrong "$name does not say what it is"
  others=$(dpkg-deb -c "$deb" | awk '$2 != "root/root" || $6 !~ /^\.\/usr\/|^\.\/(etc\/(security\/(limits\.d\/(palpate-limits\.conf)?)?)?)?$/ { print $6 }')
  [ -z "$others" ] || wrong "$name: not root's, or outside /usr: $others"
done
usr=$work/root/usr
for file in bin/palpate bin/palpate-rt bin/palpate-device lib/systemd/system/palpate@.service lib/udev/rules.d/70-palpate.rules \
  share/bash-completion/completions/palpate share/man/man1/palpate.1 share/man/man1/palpate-rt.1 \
  share/palpate/config/scenes/ellipsoid_mallet.toml share/palpate/examples/device.py share/palpate/examples/palpate_wire.py share/palpate/palpate.dbc share/palpate/odrive.dbc \
  include/palpate/rt_core/palpate_core.h lib/libpalpate_core.a; do
  [ -s "$usr/$file" ] || wrong "no package has $file"
done
# Rights of group palpate where PAM looks for them, in a file that is the administrator's to change.
cmp "$root/hal/system/palpate-limits.conf" "$work/root/etc/security/limits.d/palpate-limits.conf" || wrong "no package has the limits"
[ "$(dpkg-deb -I "$work"/palpate_*.deb conffiles)" = /etc/security/limits.d/palpate-limits.conf ] || wrong "the limits are no conffile"
[[ $(dpkg-deb -f "$work"/palpate_*.deb Depends) == *libc6* ]] || wrong "palpate does not say which libraries it needs"
! grep -rlF -e "$root" -e "$build" "$usr" || wrong "these name the folders of the build"

# A page for every command that has a help; man's own reader finds nothing to complain about.
commands=$("$usr/bin/palpate" --help | awk '/^Subcommands:/ { on = 1; next } /^$/ { on = 0 } on { print $1 }')
for command in $commands; do
  "$usr/bin/palpate" "$command" --help >/dev/null 2>&1 || continue
  page=$usr/share/man/man1/palpate-$command.1
  grep -q "^palpate-$command .- ." "$page" || wrong "$page: no name, or no meaning"
  ! command -v groff >/dev/null || ! groff -man -ww -z "$page" 2>&1 | grep . || wrong "$page: groff complains"
done
"$usr/bin/palpate" run "$usr/share/palpate/config/scenes/ellipsoid_mallet.toml" --duration 0.2 --record "$work/run.plr" >"$work/log" 2>&1 ||
  { tail "$work/log"; wrong "a run of what was packed failed"; }
"$usr/bin/palpate" replay "$work/run.plr" | grep -q '^identical' || wrong "and its recording does not replay"
# The device kit finds its table where it was packed.
/usr/bin/python3 -c "import sys; sys.dont_write_bytecode = True; sys.path.insert(0, '$usr/share/palpate/examples')
import palpate_wire; palpate_wire.read_dbc(palpate_wire.find_dbc())" || wrong "the packed device kit does not find its table"
[ "$problems" -eq 0 ] || { echo "packages: $problems problems"; exit 1; }
echo "packages: $made: no problem"
