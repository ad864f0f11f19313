#!/usr/bin/env bash
# Unread-data gate: see unread_data.cpp. Plays every shipped scene, and the choices no shipped scene makes.
# Usage: unread_data.sh PROGRAM ROOT PALPATE IMAGE_DIR
set -euo pipefail
usage="usage: unread_data.sh PROGRAM ROOT PALPATE IMAGE_DIR"
program=${1:?$usage} root=${2:?$usage} palpate=${3:?$usage} images=${4:?$usage}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# bake SCENE NAME SETTING...
bake() {
  local scene=$1 name=$2 set=()
  shift 2
  for setting in "$@"; do set+=(--set "$setting"); done
  "$palpate" bake "$root/config/scenes/$scene.toml" "${set[@]}" -o "$work/$name.pal" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
}
bake heart_compass_paper coupled coupling.law=coupled skeleton.law=paper_guarded
bake pinch_block_nodal gauss_seidel contact.nodal.solver=gauss_seidel
bake tools_on_layer relaxing 'body.material.relaxation_share=[0.2, 0.1, 0.1]' 'body.material.relaxation_s=[0.1, 1, 10]'
bake tools_on_layer ringing contact.transient.amplitude_N_per_m_s=10 contact.transient.frequency_Hz=100 contact.transient.decay_per_s=80
bake tools_on_layer losing body.material.lost_share=0.2
"$palpate" bake "$root/config/scenes/tools_on_cylinder.toml" --with "$root/config/scenes/laws/mahvash_hayward_2002.toml" \
  -o "$work/printed_table.pal" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
shipped=()
for scene in "$root"/config/scenes/*.toml; do shipped+=("$images/$(basename "$scene" .toml).pal"); done
exec "$program" "$root" "${shipped[@]}" "$work"/*.pal
