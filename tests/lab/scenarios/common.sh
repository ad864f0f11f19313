# raise_interrupts PRIORITY: puts every threaded device interrupt at that SCHED_FIFO priority.
raise_interrupts() {
  for task in /proc/[0-9]*; do
    case "$(cat "$task/comm")" in irq/*) chrt -f -p "$1" "${task#/proc/}" > /dev/null ;; esac
  done
}

# Sourced by the scenarios. render CONTROLLER_ADDRESS DEVICE_ADDRESS SECONDS: runs ellipsoid_mallet with the simulated
# device on the other end, prints the summary, verifies the recording and writes the latency histogram.
render() {
  palpate bake /lab/scenes/ellipsoid_mallet.toml -o /tmp/scene.pal > /dev/null
  palpate-device --device "$2" --path /lab/hand.csv --priority 70 & device=$!
  status=0
  palpate run /tmp/scene.pal --device "$1" --duration "$3" --record /tmp/run.plr --priority 80 --quiet || status=$?
  kill $device 2> /dev/null || true
  palpate replay /tmp/run.plr
  palpate latency --recording /tmp/run.plr --histfile /results/latency.txt --json /results/latency.json || true
  sha256sum /tmp/run.plr | cut -c1-64 > /results/recording.sha256
  return $status
}
