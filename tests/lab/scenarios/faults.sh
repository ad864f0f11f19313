# Every fault of the device in docs/faults.md, one run per script of tests/lab/faults: ends as documented, in time, with
# no force step above the limit; its black box replays to the same bits and its frames go back onto the bus.
. /lab/scenarios/common.sh
measure_kernel
cp /lab/press.csv /tmp/hand.csv
for script in /lab/faults/*.txt; do
  fault=$(sed -n '1s/^# expect \([A-Za-z]*\).*/\1/p' "$script")
  echo "== $(basename "$script" .txt): $fault"
  length=2
  [ "$(basename "$script")" != passes.txt ] || length=7
  rm -f /tmp/run.*
  start_device can:vcan0 --faults "$script"
  # A script that loses samples on purpose is not judged by how many.
  palpate run "$image" --device can:vcan0 --profile "$profile" --duration $length --record /tmp/run.plr --priority 80 --quiet --allow stale=50 ||
    [ "$fault" != none ]
  kill $device 2> /dev/null || true
  lab_check "$image" /tmp/run.plr "$fault"
  [ "$fault" != none ] || continue
  palpate replay /tmp/run.*fault*.plr
  candump -n 100 -T 3000 vcan0 > /tmp/seen & seen=$!
  sleep 0.1
  canplayer -I /tmp/run.*fault*.log
  wait $seen
  echo "canplayer: $(wc -l < /tmp/seen) frames seen again"
  [ "$(wc -l < /tmp/seen)" -eq 100 ]
done
