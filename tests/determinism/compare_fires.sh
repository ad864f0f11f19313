#!/usr/bin/env bash
# Proves that compare.sh accepts equal hashes and refuses a difference and an empty file.
set -euo pipefail
compare=$(cd "$(dirname "$0")" && pwd)/compare.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
echo 'scene 10 00000000000000aa 5 1' | tee one.txt >two.txt
echo 'scene 10 00000000000000ab 5 1' >three.txt
: >empty.txt
: >empty2.txt
"$compare" one.txt two.txt || { echo "equal hashes were refused"; exit 1; }
! "$compare" one.txt three.txt || { echo "a difference was not noticed"; exit 1; }
! "$compare" empty.txt empty2.txt || { echo "empty results were accepted"; exit 1; }
