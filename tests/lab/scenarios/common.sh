# Sourced by the scenarios. $seconds is the guest time to render.

# raise PATTERN PRIORITY: puts kernel threads whose name matches at that SCHED_FIFO priority.
raise() {
  for task in /proc/[0-9]*; do
    name=$(cat "$task/comm" 2> /dev/null) || continue
    # shellcheck disable=SC2254  # a pattern is meant
    case "$name" in $1) chrt -f -p "$2" "${task#/proc/}" > /dev/null ;; esac
  done
}

# dummy_hcd does a host controller's work in a soft timer. Its threads stand for hardware: above the simulated device,
# whose computing would hold every transfer up by 170 us, and below the loop.
raise_usb() {
  raise 'ktimers/*' 75
  raise 'ksoftirqd/*' 75
}

# The kernel's own wake-up latency in this very boot, before anything else runs.
measure_kernel() { cyclictest -m -p 90 -i 1000 -l "${1:-2000}" -q -t 1 -h 100 > /results/cyclictest.txt; }

# The hand's motion again and again for as long as the run lasts.
repeat_hand() {
  awk -F, -v seconds="$seconds" 'NR == 1 { print; next } { row[n++] = $0; split($0, f, ","); last = f[1] + 1 }
    END { for (t = 0; t < seconds; t += last) for (i = 0; i < n; i++) {
            split(row[i], f, ","); print f[1] + t substr(row[i], index(row[i], ",")) } }' /lab/hand.csv > /tmp/hand.csv
}

start_device() { # ADDRESS [OPTION...]
  at=$1
  shift
  palpate-device --device "$at" --path /tmp/hand.csv --priority 70 "$@" & device=$!
}

# latched NAME TICKS: this fault ended the run, after at least so many ticks (an earlier one would be another fault's).
latched() {
  [ "$status" -eq 1 ]
  grep -q "^FAULT *$1:" /results/log.txt
  awk -v least="$2" '/^controller:/ { if ($2 >= least) good = 1 } END { exit !good }' /results/log.txt
}

# render CONTROLLER_ADDRESS DEVICE_ADDRESS [DEVICE OPTION...]: runs ellipsoid_mallet with the simulated device on the
# other end and prints the summary. Up to a minute is also recorded, verified by replay and drawn as histograms.
render() {
  controller_at=$1
  shift
  measure_kernel
  repeat_hand
  start_device "$@"
  record=--no-record
  [ "$seconds" -gt 60 ] || record="--record /tmp/run.plr"
  status=0
  # shellcheck disable=SC2086  # two words
  palpate run /lab/ellipsoid_mallet.pal --device "$controller_at" --duration "$seconds" $record --priority 80 --quiet ||
    status=$?
  kill $device 2> /dev/null || true
  if [ "$record" != --no-record ]; then
    [ "$seconds" -gt 20 ] || palpate replay /tmp/run.plr
    palpate latency --recording /tmp/run.plr --histfile /results/latency.txt --json /results/latency.json \
      --overlay /results/cyclictest.txt --plot /results/latency.svg || true
    sha256sum < /tmp/run.plr | cut -c1-64 > /results/recording.sha256
  fi
  return $status
}
