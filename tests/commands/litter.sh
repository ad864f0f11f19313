#!/usr/bin/env bash
# Test programs leave nothing in the temporary folder (tests/own_temporary_folder.cpp): those that once did, run with one that
# is empty. Usage: litter.sh (PROGRAM FILTER)...
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: litter.sh (PROGRAM FILTER)..."; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/empty"
while [ $# -ge 2 ]; do
  ran=$(TMPDIR=$folder/empty "$1" --gtest_filter="$2") || { tail -n 20 <<<"$ran"; exit 1; }
  grep -qE '\[  PASSED  \] [1-9]' <<<"$ran" || { echo "$(basename "$1"): no test is called $2"; exit 1; }
  left=$(ls -A "$folder/empty")
  [ -z "$left" ] || { echo "$(basename "$1") leaves behind: $left"; exit 1; }
  shift 2
done
echo "litter: nothing is left behind"
