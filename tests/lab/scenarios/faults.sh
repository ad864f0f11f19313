# Every fault of the device in docs/faults.md, one run per script of tests/lab/faults: ends as documented, in time, with
# no force step above the limit; its black box replays to the same bits and its frames go back onto the bus.
. /lab/scenarios/common.sh
measure_kernel
# The device's time runs while the controller still reads its image: hand and faults wait for as long.
later_s=0.8
after() { awk -v later="$later_s" "$@"; }
after -F, 'NR == 2 { print } NR > 1 { sub($1, $1 + later) } { print }' /lab/press.csv > /tmp/hand.csv
for script in /lab/faults/*.txt; do
  fault=$(sed -n '1s/^# expect \([A-Za-z]*\).*/\1/p' "$script")
  echo "== $(basename "$script" .txt): $fault"
  after '/^[0-9]/ { $1 += later } { print }' "$script" > /tmp/faults.txt
  length=2.5
  [ "$(basename "$script")" != passes.txt ] || length=7.5
  rm -f /tmp/run.*
  start_device can:vcan0 --faults /tmp/faults.txt
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
