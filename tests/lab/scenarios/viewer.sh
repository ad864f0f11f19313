# Readers of telemetry, as a viewer is one: attached, killed, stopped, flooding; then hostile ones. Against runs without any.
. /lab/scenarios/common.sh
measure_kernel
repeat_hand

# part NAME [OPTION...]: one run; its summary in /tmp/NAME.txt
part() {
  name=$1
  shift
  start_device can:vcan0 --bus-model fd
  palpate run "$image" --device can:vcan0 --profile "$profile" --duration "$seconds" --record /tmp/$name.plr --priority 80 --quiet "$@" \
    > /tmp/$name.txt 2>&1 || { cat /tmp/$name.txt; exit 1; }
  kill $device
  wait $device || true
  palpate latency --recording /tmp/$name.plr --histfile /results/latency_$name.txt --json /results/latency_$name.json > /dev/null || true
  echo "== $name"
  cat /tmp/$name.txt
}

# read_all WHAT...: these readers until the door is gone. Of a viewer one is killed and one stopped, in the middle of reading, again and again.
read_all() {
  while [ ! -S /tmp/telemetry ]; do sleep 0.05; done
  sleep 0.5
  readers=''
  for what in "$@"; do
    lab_readers "$what" /tmp/telemetry & readers="$readers $!"
  done
  while [ -S /tmp/telemetry ]; do
    lab_readers follow /tmp/telemetry & killed=$!
    lab_readers follow /tmp/telemetry & stopped=$!
    sleep 0.7
    kill -KILL $killed 2> /dev/null || true
    kill -STOP $stopped 2> /dev/null || true
    sleep 1.5
    kill -CONT $stopped 2> /dev/null || true
    kill -KILL $stopped 2> /dev/null || true
    echo round >> /tmp/rounds
  done
  # Who broke in has ended by itself.
  for reader in $readers; do kill -KILL $reader || echo "reader $reader had ended" >> /tmp/broken; done
}

# By turns, and of each the largest of three: once or twice in a run the kernel holds a frame up by 8 to 10 us, with readers
# or without (three of seven runs without, all of seven with a viewer, 2026-11-25), so that one maximum alone says little.
for turn in 1 2 3; do
  part alone_$turn
  read_all follow flood 2> /dev/null & watched=$!
  part viewer_$turn --telemetry /tmp/telemetry
  wait $watched
done
read_all follow knock break 2> /dev/null & watched=$!
part hostile --telemetry /tmp/telemetry
wait $watched
cp /tmp/viewer_3.plr /results/run.plr
sha256sum < /tmp/viewer_3.plr | cut -c1-64 > /results/recording.sha256
[ ! -e /tmp/broken ] || { cat /tmp/broken; exit 1; }
echo "== readers: $(wc -l < /tmp/rounds) killed, as many stopped for 1.5 s"

largest() { awk -v line="$2" -v field="$3" 'index($0, "  " line) == 1 { print $field; exit }' "$1"; } # FILE LINE FIELD
most() { for turn in 1 2 3; do largest "/tmp/$1_$turn.txt" "$2" "$3"; done | sort -n | tail -n 1; } # NAME LINE FIELD: of its turns
failed=''
# Every part of a tick that a reader could make dearer. The latest command is their sum in one tick, which also says what else
# that tick had to do: a kernel's hold that meets a contact is told, and is held to what is asked of every run.
for line in "wake-up latency 5" "receive 4" "compute 4" "transmit 4" "telemetry 4" "deadline to sent 6"; do
  what=${line% *} field=${line##* }
  alone=$(most alone "$what" "$field") viewer=$(most viewer "$what" "$field")
  echo "== $what, max: $alone us alone, $viewer us with a viewer, $(largest /tmp/hostile.txt "$what" "$field") us with hostile readers"
  [ "$what" = "deadline to sent" ] || awk -v a="$alone" -v b="$viewer" 'BEGIN { exit !(a > 0 && b > 0 && b - a < 2) }' ||
    failed="$failed; a viewer costs 2 us or more: $what"
done
count() { awk '/^controller: /{ print $4, $NF; exit }' "$1"; } # ticks missed, faults
for name in alone_2 alone_3 viewer_1 viewer_2 viewer_3 hostile; do
  [ "$(count /tmp/alone_1.txt)" = "$(count /tmp/$name.txt)" ] || failed="$failed; missed ticks or faults differ with $name readers"
done
[ -z "$failed" ] || { echo "${failed#; }"; exit 1; }
