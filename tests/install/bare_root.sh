#!/usr/bin/env bash
# The packages in a Debian that has nothing but its essentials: a root of debootstrap's (minbase), into which apt installs
# them with what they need; the demo then runs there as an ordinary user, and after a purge no package and no file is left
# that was not there before, but the user `palpate` and its folder, as Debian's services leave them.
# Needs root, debootstrap and the network (`./run packages`); the root is kept as a tar file, so that it is fetched once.
# Usage: bare_root.sh FOLDER_OF_DEBS CACHE_FOLDER [SUITE]
set -euo pipefail
usage="usage: bare_root.sh FOLDER_OF_DEBS CACHE_FOLDER [SUITE]"
debs=$(realpath "${1:?$usage}") cache=${2:?$usage} suite=${3:-bookworm}
[ "$(id -u)" -eq 0 ] || { echo "bare_root.sh: run it as root: it changes root and mounts"; exit 2; }
command -v debootstrap >/dev/null || { echo "bare_root.sh: needs the package debootstrap"; exit 2; }
compgen -G "$debs/palpate_*.deb" >/dev/null || { echo "bare_root.sh: no palpate_*.deb in $debs"; exit 2; }
mkdir -p "$cache"
cache=$(realpath "$cache")
if [ "${PALPATE_BARE_ROOT:-}" = "" ]; then # mounts of its own, which end with this process
  PALPATE_BARE_ROOT=$(mktemp -d "${TMPDIR:-/tmp}/palpate-root.XXXXXX")
  export PALPATE_BARE_ROOT
  status=0
  unshare --mount --pid --fork bash "$0" "$debs" "$cache" "$suite" || status=$?
  rm -rf --one-file-system "$PALPATE_BARE_ROOT"
  exit $status
fi
root=$PALPATE_BARE_ROOT
problems=0
wrong() { echo "$*"; problems=$((problems + 1)); }
within() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive HOME=/tmp "$@"; }
packages() { within dpkg-query -W -f '${db:Status-Abbrev}${Package}\n' | grep '^i' | LC_ALL=C sort; }
# What apt, dpkg and the loader keep for themselves is not the packages' doing.
files() {
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./tmp -o -path ./var/cache -o -path ./var/lib/apt -o -path ./var/lib/dpkg \
    -o -path ./var/log -o -path ./dev -o -path ./run \) -prune -o -print | grep -vE '^\./etc/(ld\.so\.cache|(passwd|group|shadow|gshadow|sub[ug]id)-?)$|^\./etc/\.pwd\.lock$' | LC_ALL=C sort)
}

if [ ! -s "$cache/$suite.tar" ]; then
  debootstrap --variant=minbase "$suite" "$root" >"$cache/$suite.log" 2>&1 || { tail -n 5 "$cache/$suite.log"; exit 1; }
  tar -C "$root" --one-file-system -cf "$cache/$suite.tar.part" . && mv "$cache/$suite.tar.part" "$cache/$suite.tar"
else
  tar -C "$root" -xf "$cache/$suite.tar"
fi
chmod 755 "$root" # mktemp's folder, and so the archive's, is root's alone: the demo's user could not even enter it
mount -t proc proc "$root/proc"
mount -t tmpfs -o mode=1777 tmpfs "$root/tmp"
[ ! -e /etc/resolv.conf ] || cp -L /etc/resolv.conf "$root/etc/resolv.conf"
cp "$debs"/*.deb "$root/tmp/"
within apt-get update >"$cache/apt.log" 2>&1 || { tail -n 5 "$cache/apt.log"; exit 1; }
packages >"$root/tmp/packages.before"
files >"$root/tmp/files.before"

# --- install ---
mine=$(for deb in "$debs"/*.deb; do dpkg-deb -f "$deb" Package; done | tr '\n' ' ')
within sh -c 'apt-get install -y --no-install-recommends /tmp/*.deb' >>"$cache/apt.log" 2>&1 ||
  { tail -n 20 "$cache/apt.log"; echo "the packages do not install in a bare $suite"; exit 1; }
packages >"$root/tmp/packages.after"
echo "installed $mine and $(($(wc -l <"$root/tmp/packages.after") - $(wc -l <"$root/tmp/packages.before") - $(wc -w <<<"$mine"))) packages they need"
within getent passwd palpate >/dev/null || wrong "there is no user palpate"

# --- the demo, as somebody without rights ---
cat >"$root/tmp/demo.sh" <<'DEMO'
set -e
mkdir /tmp/demo && cd /tmp/demo
palpate | grep -q 'palpate run'
scene=/usr/share/palpate/config/scenes/ellipsoid_mallet.toml
palpate run $scene --duration 10s --record run.plr
palpate replay run.plr
palpate picture run.plr -o run.png --plot force.svg
palpate press $scene --out forces.csv
palpate movie run.plr --fps 5 --width 320 --height 240 -o run.moving.png
palpate doctor >doctor.txt || [ $? -eq 1 ]
palpate run /usr/share/palpate/config/scenes/grasp_cylinder_2.toml --duration 4s --json >grasp.json
DEMO
within setpriv --reuid=65534 --regid=65534 --clear-groups sh /tmp/demo.sh >"$root/tmp/demo.log" 2>&1 ||
  { tail -n 20 "$root/tmp/demo.log"; wrong "the demo does not run"; }
grep -E '^(ticks|force|identical)' "$root/tmp/demo.log" || wrong "the demo says nothing of its ticks"
if [ -e "$root/usr/bin/palpate-view" ]; then within palpate view --help >/dev/null || wrong "palpate view does not start"; fi
if [ -d "$root/usr/lib/python3/dist-packages/palpate" ]; then
  within python3 -c 'import palpate; print("python: a recording of", len(palpate.Recording("/tmp/demo/run.plr").ticks), "ticks")' ||
    wrong "the Python module does not read the recording"
fi

# --- remove ---
# shellcheck disable=SC2086  # a list of words
within apt-get purge -y $mine >>"$cache/apt.log" 2>&1 || wrong "the packages cannot be purged"
within apt-get autoremove --purge -y >>"$cache/apt.log" 2>&1 || wrong "what they needed cannot be removed"
packages >"$root/tmp/packages.end"
files >"$root/tmp/files.end"
diff "$root/tmp/packages.before" "$root/tmp/packages.end" >"$cache/packages.diff" || { cat "$cache/packages.diff"; wrong "packages are left"; }
left=$(LC_ALL=C comm -13 "$root/tmp/files.before" "$root/tmp/files.end" | grep -vE '^\./var/lib/palpate(/|$)|__pycache__|^\./var/lib/systemd/' || true)
[ -z "$left" ] || { head -n 20 <<<"$left"; wrong "files are left"; }
gone=$(LC_ALL=C comm -23 "$root/tmp/files.before" "$root/tmp/files.end")
[ -z "$gone" ] || { head -n 20 <<<"$gone"; wrong "files are gone that were there before"; }
[ "$problems" -eq 0 ] || { echo "bare $suite: $problems problems"; exit 1; }
echo "bare $suite: installed, played and removed: no problem"
