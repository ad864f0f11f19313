#!/usr/bin/env bash
# The libraries that Palpate links, for AArch64, from the archive this machine installs from. Nothing is installed: the
# packages are downloaded and unpacked into FOLDER, once, with package lists of their own, so that the machine's dpkg need
# not know a second processor. Usage: libraries.sh FOLDER
set -euo pipefail
folder=$(mkdir -p "${1:?usage: libraries.sh FOLDER}" && cd "$1" && pwd)
packages='libccd2 libccd-dev libfmt9 libfmt-dev libassimp5 libassimp-dev libmetis5 libmetis-dev libminizip1 libdraco7 zlib1g zlib1g-dev libpng16-16
  libpng-dev libpugixml1v5 libpugixml-dev libgtest-dev libgmock-dev'
[ "$(cat "$folder/complete" 2> /dev/null)" != "$packages" ] || exit 0

apt=$folder/apt
rm -rf "$folder"/* && mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial" "$apt/packages"
: > "$apt/status"
cat > "$apt/settings" <<TEXT
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Sandbox::User "$(id -un)";
Dir::State "$apt";
Dir::State::status "$apt/status";
Dir::Cache "$apt/cache";
TEXT
export APT_CONFIG=$apt/settings
echo "downloading the libraries for AArch64 (once, 5 MB)"
apt-get update -qq || echo "note: not every package list could be read"
# shellcheck disable=SC2086  # a list of words
(cd "$apt/packages" && apt-get download -qq $packages) || { echo "these packages cannot be downloaded for arm64: $packages"; exit 3; }
for package in "$apt"/packages/*.deb; do dpkg -x "$package" "$folder"; done
rm -rf "$apt"
# Links to the root of the machine they were packed for, now to this folder.
find "$folder" -type l -lname '/*' | while read -r link; do ln -sfn "$folder$(readlink "$link")" "$link"; done
printf '%s\n' "$packages" > "$folder/complete"
