#!/usr/bin/env bash
# Unread-data gate: see unread_data.cpp. Plays every shipped scene, and the choices no shipped scene makes.
# Usage: unread_data.sh PROGRAM ROOT PALPATE IMAGE_DIR
set -euo pipefail
usage="usage: unread_data.sh PROGRAM ROOT PALPATE IMAGE_DIR"
program=${1:?$usage} root=${2:?$usage} palpate=${3:?$usage} images=${4:?$usage}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bake() { "$palpate" bake "$root/config/scenes/$1.toml" --set "$2" -o "$work/$3.pal" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }; }
bake heart_compass_paper coupling.law=temporal_paper temporal
bake pinch_block contact.nodal.solver=gauss_seidel gauss_seidel
shipped=()
for scene in "$root"/config/scenes/*.toml; do shipped+=("$images/$(basename "$scene" .toml).pal"); done
exec "$program" "$root" "${shipped[@]}" "$work"/*.pal
