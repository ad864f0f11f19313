#!/usr/bin/env bash
# The laboratory: boots PREEMPT_RT in deterministic virtual time, runs scenarios in it, judges them by their numbers.
# Verdicts and files stay in out/lab/SCENARIO. See docs/laboratory.md.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
cache=${PALPATE_LAB_CACHE:-$root/build/lab/cache}
programs=$root/build/release/laboratory
results=$root/out/lab
jobs=${PALPATE_JOBS:-$(nproc)}
every='faults usb kvaser vcan vcan_classic:21 determinism cyclictest'
standard="$every scene_grasp_cylinder_5 scene_ring"
scenes=$(cd "$root/config/scenes" && printf 'scene_%s ' *.toml | sed 's/\.toml//g')
# Drives and two devices: recorded for 10 s, and for 60,000 ticks, a second more than that because the loop follows the
# device's clock. Those of two devices are recorded in any case.
drives='vcan_odrive vcan_cia402 vcan_moteus falcon vcan_odrive:61 vcan_cia402:61 vcan_moteus:61 falcon:61 vcan_two_hands:61 vcan_two_tools:61'
thorough="$every scenes buses vcan_2khz usb_2khz vcan_classic vcan_clock $drives usb_kit usb_unplug host_chaos viewer vcan:60 kvaser:60 usb:60 vcan_classic:600"

usage() {
  cat << TEXT
Usage: ./run lab [--all | --list] [SCENARIO[:SECONDS]...]
  Without scenarios: $standard
  --all            $thorough
  --list           every scenario with its first words; scene_NAME is a scene, and "scenes" all of them
  --judge          judges again what lies in out/lab; boots nothing
  --docs           writes rows and plots of what lies in out/lab into docs/laboratory.md, other rows stay; boots nothing
  --programs DIR   where palpate, palpate-rt and palpate-device are; default build/release/laboratory
PALPATE_LAB_CACHE: folder of the downloaded kernel (build/lab/cache). PALPATE_JOBS: scenarios at a time ($jobs).
TEXT
}

die() {
  echo "lab: $*" >&2
  exit 3
}

# What the numbers must be. Wake-up: cyclictest in the same boot plus 10 us. Sent: deadline to command handed to the bus.
allowance_us=10
sent_limit_us=150
unplug_allowance_us=45 # 35 us more, once: docs/laboratory.md, what the laboratory found in the kernel
scene_limit_us=500 # of every other scene: half the period, as palpate latency --certify asks

field() { awk "$1" "$log" 2> /dev/null; } # AWK: one number out of the scenario's log

read_numbers() { # RESULT_DIR
  log=$1/log.txt
  forced=$(field '/^loop thread:/ { s += $12; n++ } END { if (n) print s }')
  heap=$(field '/^loop thread:.* heap calls$/ { s += $14; n++ } END { if (n) print s }')
  missed=$(field '/^controller: .* missed/ { s += $4; n++ } END { if (n) print s }')
  ticks=$(field '/^controller: .* ticks/ { s += $2; n++ } END { if (n) print s }')
  faults=$(field '/^loop thread:/ { s += $3 + $6; n++ } END { if (n) print s }')
  wake=$(field '/^  wake-up latency/ { if ($5 > m) m = $5 } END { if (m) print m }')
  sent=$(field '/^  deadline to sent/ { if ($6 > m) m = $6 } END { if (m) print m }')
  deep=$(field '/^force   / { if ($12 > m) m = $12 } END { if (NR) print m + 0 }')
  hand=$(field '/^force   / { if ($2 > m) m = $2 } END { if (NR) print m + 0 }')
  lost=$(field '/records lost/ { for (i = 2; i <= NF; i++) if ($i == "records") s += $(i - 1); n++ } END { if (n) print s }')
  kernel=$(awk '/^# Max Latencies/ { print $4 + 0 }' "$1/cyclictest.txt" 2> /dev/null)
}

above() { awk -v a="${1:-0}" -v b="$2" 'BEGIN { exit !(a > b) }'; }

judge() { # SCENARIO FOLDER: problems found in the numbers, one a line
  local name=$1 limit_us=$sent_limit_us late_us=$allowance_us
  [ "$(cat "$results/$2/exit_code" 2> /dev/null)" = 0 ] || echo "the scenario failed: see $results/$2/log.txt"
  if [ -n "$kernel" ] && [ "$name" = cyclictest ]; then
    ! above "$kernel" 100 || echo "the kernel itself wakes up late: $kernel us"
  fi
  case $name in cyclictest | buses) return ;; esac
  [ -n "$ticks" ] || { echo "the controller said nothing"; return; }
  [ "$missed" = 0 ] || echo "$missed ticks missed"
  [ "$faults" = 0 ] || echo "$faults page faults in the loop"
  [ "$heap" = 0 ] || echo "${heap:-uncounted} heap calls in the loop"
  # Interrupt threads and the writer of USB reports run above the loop on purpose; on vcan nothing does.
  case $name in vcan* | host_chaos | viewer | faults | scene_*) [ "$forced" = 0 ] || echo "the loop was preempted $forced times" ;; esac
  [ -n "$wake" ] && [ -n "$kernel" ] || { echo "no latency measured"; return; }
  [ "$name" != usb_unplug ] || late_us=$unplug_allowance_us
  ! above "$wake" $((kernel + late_us)) || echo "wake-up $wake us, cyclictest $kernel us"
  case $name in scene_ellipsoid_mallet*) ;; scene_*) limit_us=$scene_limit_us ;; esac
  ! above "$sent" $limit_us || echo "deadline to sent $sent us, allowed $limit_us us"
  [ ! -e "$results/$2/replay.txt" ] || grep -q '^identical' "$results/$2/replay.txt" || echo "another result outside the guest"
  case $name in # a grasp's forces cancel
    scene_*) above "$deep" 0.1 || echo "the tool touched nothing" ;;
    *) above "$hand" 0.5 || echo "the hand felt nothing" ;;
  esac
  case $name in host_chaos) ;; *) [ "${lost:-0}" = 0 ] || echo "$lost records lost" ;; esac
}

verdict() { # SCENARIO[:SECONDS] [SECONDS TAKEN]: reads and judges the results
  local name=${1%%:*} folder=${1/:/_} problems
  read_numbers "$results/$folder"
  problems=$(judge "$name" "$folder" | paste -sd ';')
  printf '%-7s %-28s %7s ticks  missed %s  wake-up max %s us (cyclictest %s)  sent max %s us  page faults %s  heap calls %s%s%s\n' \
    "$([ -z "$problems" ] && echo passed || echo FAILED)" "$1" "${ticks:--}" "${missed:--}" "${wake:--}" "${kernel:--}" \
    "${sent:--}" "${faults:--}" "${heap:--}" "${2:+  [$2 s]}" "${problems:+  $problems}" | tee "$results/$folder/verdict.txt"
  # Where the folder is gone afterwards, as after a run in CI, this is all there is of it.
  [ -z "$problems" ] || tail -n 8 "$results/$folder/log.txt" 2> /dev/null | sed 's/^/  | /'
}

default_seconds() { # SCENARIO
  case $1 in
    cyclictest) echo 20 ;;
    scene_*) awk -F, 'END { print int($1 + 0.999) }' "$out/scenes/${1#scene_}.csv" ;; # its path
    *) echo 10 ;;
  esac
}

replay_outside() { # SCENARIO RESULT_DIR: what was computed inside must be what a real processor computes
  local scene=ellipsoid_mallet
  [ -e "$2/run.plr" ] || return
  case $1 in scene_*) scene=${1#scene_} ;; vcan_two_hands) scene=two_hands ;; vcan_two_tools) scene=two_tools ;; *_2khz) scene=mallet_2khz ;; falcon) scene=falcon ;; esac
  "$out/palpate" replay "$2/run.plr" --image "$out/scenes/$scene.pal" > "$2/replay.txt" 2>&1
  rm "$2/run.plr"
}

run_one() { # SCENARIO[:SECONDS]
  local name=${1%%:*} seconds=${1#*:} folder=${1/:/_} started=$SECONDS
  [ "$seconds" != "$1" ] || seconds=$(default_seconds "$name")
  rm -rf "${results:?}/$folder"
  mkdir -p "$results/$folder"
  cp "$out/commit" "$results/$folder/"
  if [ "$name" = determinism ]; then
    determinism "$folder"
    return
  fi
  if ! bash "$here/boot.sh" run "$out" "$name" "$seconds" "$results/$folder" $((300 + 10 * seconds)) 2> "$results/$folder/boot.txt"; then
    cat "$results/$folder/boot.txt" >&2
  fi
  replay_outside "$name" "$results/$folder"
  verdict "$1" $((SECONDS - started))
}

determinism() { # FOLDER: two runs of one scenario must give the same bytes, to the last digit of the kernel's log
  local run file differ='' started=$SECONDS
  for run in 1 2; do
    mkdir -p "$results/$1/$run"
    bash "$here/boot.sh" run "$out" vcan 3 "$results/$1/$run" 400 || differ=" run $run failed"
    rm -f "$results/$1/$run/run.plr"
  done
  for file in recording.sha256 latency.txt cyclictest.txt kernel.log log.txt; do
    [ -s "$results/$1/1/$file" ] && cmp -s "$results/$1/1/$file" "$results/$1/2/$file" || differ+=" $file differs"
  done
  printf '%-7s %-28s two runs of vcan:3: recording %.12s, histograms, kernel log %s  [%s s]\n' \
    "$([ -z "$differ" ] && echo passed || echo FAILED)" determinism "$(cat "$results/$1/1/recording.sha256" 2> /dev/null)" \
    "${differ:-identical}" $((SECONDS - started)) | tee "$results/$1/verdict.txt"
}

judge_again() { # everything in out/lab
  local folder name
  for folder in "$results"/*/; do
    name=$(basename "$folder")
    case $name in determinism) continue ;; scene_*) ;; *) name=$(sed -E 's/_([0-9]+)$/:\1/' <<< "$name") ;; esac
    [ ! -e "$folder/log.txt" ] || verdict "$name"
  done
}

this_commit() { # the last that touched a program or the laboratory; + if it has been changed since
  local but_docs=(-- . ':!docs' ':!*.md') commit
  commit=$(git -C "$root" log -1 --format=%h "${but_docs[@]}" 2> /dev/null) || { echo -; return; }
  git -C "$root" diff --quiet HEAD "${but_docs[@]}" && echo "$commit" || echo "$commit+"
}

# The table between its marks in docs/laboratory.md, and the histograms of the long runs. What was not run this time keeps
# its row, with the date and the commit of its own.
write_docs() {
  local page=$root/docs/laboratory.md name
  [ -e "$results/table.md" ] || die "no results: run some scenarios first"
  {
    sed '/^|---/q' "$results/table.md"
    { sed '1,/^|---/d' "$results/table.md"; sed -n '/^<!-- table/,/^<!-- end of table/p' "$page" | sed '1,/^|---/d' | grep '^| '; } |
      LC_ALL=C sort -s -u -t '|' -k 2,2
  } > "$results/page_table.md"
  for name in vcan_classic_600 vcan_60 kvaser_60 usb_60; do
    [ ! -e "$results/$name/latency.svg" ] || cp "$results/$name/latency.svg" "$root/docs/pictures/latency_$name.svg"
  done
  awk -v table="$results/page_table.md" '/^<!-- table/ { print; while ((getline line < table) > 0) print line; skip = 1; next }
    /^<!-- end of table/ { skip = 0 } !skip { print }' "$page" > "$page.new" && mv "$page.new" "$page"
}

table() { # every verdict there is, as a dated table for docs/laboratory.md
  local folder name
  printf '| scenario | ticks | missed | page faults | heap calls | preemptions | wake-up max (cyclictest), µs | deadline to sent max, µs | verdict | date | commit |\n'
  printf '|---|---|---|---|---|---|---|---|---|---|---|\n'
  for folder in "$results"/*/; do
    [ -e "$folder/verdict.txt" ] || continue
    name=$(basename "$folder")
    read_numbers "$folder"
    printf '| %s | %s | %s | %s | %s | %s | %s (%s) | %s | %s | %s | %s |\n' "$name" "${ticks:--}" "${missed:--}" "${faults:--}" \
      "${heap:--}" "${forced:--}" "${wake:--}" "${kernel:--}" "${sent:--}" "$(cut -d' ' -f1 "$folder/verdict.txt")" \
      "$(date -u -r "$folder/verdict.txt" +%Y-%m-%d)" "$(cat "$folder/commit" 2> /dev/null || echo -)"
  done
}

write_table() {
  {
    printf 'In virtual time, kernel %s; generated by `./run lab --docs`.\n\n' "$(basename "$cache"/x/lib/modules/*)"
    table
  } > "$results/table.md"
}

if [ "${1:-}" = --one ]; then # this script calls itself for each scenario
  out=$3
  results=$4
  run_one "$2"
  exit
fi

scenarios=()
while [ $# -gt 0 ]; do
  case $1 in
    --judge | --docs)
      [ "$1" = --docs ] || judge_again
      write_table
      [ "$1" = --judge ] || write_docs
      exit 0
      ;;
    --all) read -ra scenarios <<< "$thorough" ;;
    --list)
      for file in "$here"/scenarios/*.sh; do
        case $file in */common.sh | */scene.sh) continue ;; esac
        printf '%-28s %s\n' "$(basename "$file" .sh)" "$(sed -n '1s/^# //p' "$file")"
      done
      for file in $scenes; do
        printf '%-28s %s\n' "$file" "config/scenes/${file#scene_}.toml along its own path, CAN FD on vcan"
      done
      printf '%-28s %s\n' scenes 'every one of these'
      printf '%-28s %s\n' determinism 'vcan run twice: recording, histograms and kernel log must be the same'
      exit 0
      ;;
    --programs) programs=$(cd "${2:?}" && pwd) && shift ;;
    --help | -h) usage && exit 0 ;;
    -*) usage >&2 && exit 2 ;;
    *) scenarios+=("$1") ;;
  esac
  shift
done
[ ${#scenarios[@]} -gt 0 ] || read -ra scenarios <<< "$standard"
words=" ${scenarios[*]} "
read -ra scenarios <<< "${words/ scenes / $scenes }"
for one in "${scenarios[@]}"; do
  case ${one%%:*} in
    determinism) continue ;;
    scene_*) file=$root/config/scenes/${one#scene_} && file=${file%%:*}.toml ;;
    *) file=$here/scenarios/${one%%:*}.sh ;;
  esac
  [ -e "$file" ] || die "no scenario '$one': see lab.sh --list"
done
for tool in qemu-system-x86_64 cpio busybox; do
  command -v $tool > /dev/null || die "$tool is missing: apt-get install qemu-system-x86 cpio busybox-static iproute2 kmod"
done
for program in palpate palpate-rt palpate-device lab_host lab_check lab_scene lab_readers lab_idle; do
  [ -x "$programs/$program" ] || die "$programs/$program is missing: build first, or give --programs DIR"
done

out=$(mktemp -d "${TMPDIR:-/tmp}/palpate-lab.XXXXXX")
trap 'rm -rf "$out"' EXIT
this_commit > "$out/commit"
cp "$programs/palpate" "$out/" # a long run may outlive the build
mkdir "$out/scenes"
for one in $scenes; do
  one=${one#scene_}
  cp "$programs/../scenes/$one.pal" "$out/scenes/" || die "the scenes are not baked: build the target scene_images"
  "$programs/lab_scene" "$root/config/scenes/$one.toml" "$out/scenes" || die "$one.toml cannot be read"
done
bake() { # NAME SCENE [OPTION...]: a scene that is not shipped as it is
  local name=$1 scene=$2
  shift 2
  "$programs/palpate" bake "$root/config/scenes/$scene.toml" "$@" -o "$out/scenes/$name.pal" > "$out/bake.log" 2>&1 ||
    { cat "$out/bake.log"; die "$name cannot be baked"; }
}
case " ${scenarios[*]} " in # the mallet in one hand, the body in the other
  *" vcan_two_hands"*) bake two_hands ellipsoid_mallet --set device.holds=both --set 'device.grip_mm=[0, 0, 0]' ;;
esac
case " ${scenarios[*]} " in
  *_2khz*) bake mallet_2khz ellipsoid_mallet --set device.period_ms=0.5 ;;
esac
case " ${scenarios[*]} " in
  *" falcon"*) bake falcon ellipsoid_mallet --with "$root/config/devices/example-falcon.toml" ;;
esac
case " ${scenarios[*]} " in
  *" vcan_two_tools"*) bake two_tools ring --with "$root/config/scenes/hands/two_tools.toml" ;;
esac
# The device kit, with Debian's Python and the modules that it imports: what Python's home is has lib/python3.11 in it.
python=/usr/bin/python3
pack_kit() { # FOLDER
  local home file
  mkdir -p "$1"
  cp "$root"/docs/examples/device_kit.py "$root"/sim_host/python/palpate_wire.py "$root"/docs/palpate.dbc "$1/"
  home=$($python -c 'import sys; print(sys.base_prefix)')
  (cd "$1" && $python -S -E -B -c 'import sys; sys.path.insert(0, "."); import device_kit
for module in list(sys.modules.values()): print(getattr(module, "__file__", None) or "")') | grep "^$home/" | sort -u | while read -r file; do
    mkdir -p "$1/$(dirname "${file#"$home"/}")"
    cp "$file" "$1/${file#"$home"/}"
  done
}
kit=()
guest_programs=("$programs"/{palpate,palpate-rt,palpate-device,lab_host,lab_check,lab_readers,lab_idle})
case " ${scenarios[*]} " in
  *" usb_kit"*)
    pack_kit "$out/kit" && kit=("$out/kit") guest_programs+=("$python") || die "the device kit cannot be packed: apt-get install python3" ;;
esac
bash "$here/guest.sh" "$cache" "$out" "${guest_programs[@]}" -- \
  "$here"/{scenarios,faults,hand.csv,press.csv} "$root/config/devices" "$out/scenes" "${kit[@]}" || die "cannot build the guest"
echo "lab: booting the guest" >&2
bash "$here/boot.sh" save "$out" || die "the guest does not boot"
mkdir -p "$results"
printf '%s\n' "${scenarios[@]}" | xargs -P "$jobs" -I{} bash "$here/lab.sh" --one {} "$out" "$results" | tee "$out/verdicts"
write_table
failed=$(grep -c '^FAILED' "$out/verdicts")
passed=$(grep -c '^passed' "$out/verdicts")
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -eq ${#scenarios[@]} ]
