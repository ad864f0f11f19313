#!/usr/bin/env bash
# The packages `palpate` and `libpalpate-dev` for arm64, from what was built for AArch64; completion and manual are the same
# text for every processor and come from the other build. The library's component `core` alone is packed: the tick, for
# images that are baked on x86-64. What is in them is then used under the emulator, as it was unpacked: programs run, a
# scene is baked, an example is built against the library and ticks a scene.
# Usage: package.sh RELEASE_BUILD_DIR AARCH64_BUILD_DIR FOLDER
set -euo pipefail
usage='usage: package.sh RELEASE_BUILD_DIR AARCH64_BUILD_DIR FOLDER'
release=${1:?$usage} build=$(cd "${2:?$usage}" && pwd) folder=$(mkdir -p "${3:?$usage}" && cd "$3" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
wrong() { echo "$*"; exit 1; }

# dpkg-shlibdeps asks the machine's own packages, which are of another processor: the names of the library packages that
# the programs' NEEDED entries lead to, by the packages that were unpacked.
declare -A package=([libc.so.6]=libc6 [libm.so.6]=libc6 [ld-linux-aarch64.so.1]=libc6 [libstdc++.so.6]=libstdc++6 [libgcc_s.so.1]=libgcc-s1
  [libccd.so.2]=libccd2 [libfmt.so.9]=libfmt9 [libassimp.so.5]=libassimp5 [libpugixml.so.1]=libpugixml1v5 [libpng16.so.16]=libpng16-16 [libz.so.1]=zlib1g)
libraries_of_programs() {
  local library name needs='adduser, gmsh'
  for library in $(aarch64-linux-gnu-readelf -d "$build"/bin/palpate "$build"/bin/palpate-rt "$build"/bin/palpate-device |
    sed -n 's/.*(NEEDED).*\[\(.*\)\].*/\1/p' | LC_ALL=C sort -u); do
    name=${package[$library]:-}
    [ -n "$name" ] || wrong "no package is known for $library: name it in $0" >&2
    [[ ", $needs," == *", $name,"* ]] || needs+=", $name"
  done
  echo "$needs"
}

pack() {
  local needs deb
  needs=$(libraries_of_programs)
  cp "$release/palpate.bash" "$build/"
  mkdir -p "$build/manual"
  cp "$release"/manual/* "$build/manual/"
  rm -f "$build/manual/palpate-mesh.1" # that program is not built for it
  rm -rf "${folder:?}"/* # an older one would be tried, too
  cpack --config "$build/CPackConfig.cmake" -G DEB -B "$folder" -D 'CPACK_COMPONENTS_ALL=programs;core' \
    -D CPACK_DEBIAN_PACKAGE_ARCHITECTURE=arm64 -D CPACK_DEBIAN_PACKAGE_SHLIBDEPS=OFF \
    -D CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS="$needs" -D CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS=libccd-dev > "$folder/cpack.txt" ||
    { cat "$folder/cpack.txt"; wrong "no package was made"; }
  rm -rf "$folder/_CPack_Packages" "$folder/cpack.txt"
  for deb in "$folder"/{palpate,libpalpate-dev}_*_arm64.deb; do
    [ "$(dpkg-deb -f "$deb" Architecture)" = arm64 ] || wrong "$deb is not for arm64"
    dpkg-deb -x "$deb" "$root"
  done
}

try_programs() {
  local program
  for program in palpate palpate-rt palpate-device; do
    "$here/emulator.sh" "$root/usr/bin/$program" --help > "$root/help.txt" || wrong "$program does not run"
    grep -q palpate "$root/help.txt" || wrong "$program says nothing"
  done
  # A scene of springs, which needs no mesher, is baked.
  "$here/emulator.sh" "$root/usr/bin/palpate" bake "$here/../../config/scenes/ellipsoid_mallet_paper.toml" -o "$root/scene.pal" > "$root/bake.txt" ||
    { cat "$root/bake.txt"; wrong "it bakes no scene"; }
}

# docs/examples against the package alone.
try_library() {
  local said
  { cmake -S "$here/../../docs/examples" -B "$root/examples" -G Ninja --toolchain "$here/toolchain.cmake" -DCMAKE_BUILD_TYPE=Release \
    -Dpalpate_DIR="$root/usr/lib/cmake/palpate" && cmake --build "$root/examples" --target embed_tick; } > "$root/examples.txt" ||
    { tail -n 20 "$root/examples.txt"; wrong "the example is not built with libpalpate-dev"; }
  said=$("$here/emulator.sh" "$root/examples/embed_tick" "$root/scene.pal") || wrong "the example does not run: $said"
  # A tool that presses meets force, and none is left when it has gone.
  [[ $said =~ 'at most '([0-9.]+)' N, at the end '-?0\.000 ]] && awk -v force="${BASH_REMATCH[1]}" 'BEGIN { exit !(force > 0.1) }' ||
    wrong "the example feels nothing: $said"
  echo "embed_tick built with it: $said"
}

pack
try_programs
try_library
for deb in "$folder"/*.deb; do
  ls -sh "$deb"
  dpkg-deb -f "$deb" Depends
done
