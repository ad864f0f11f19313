# Sourced by the scenarios. $seconds is the guest time to render; $period_us that of the image where it is not 1000.
image=/lab/scenes/ellipsoid_mallet.pal
profile=/lab/devices/sim-6dof.toml

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
measure_kernel() { cyclictest -m -p 90 -i "${period_us:-1000}" -l "${1:-2000}" -q -t 1 -h 100 > /results/cyclictest.txt; }

# The hand's motion again and again for as long as the run lasts.
repeat_hand() {
  awk -F, -v seconds="$seconds" 'NR == 1 { print; next } { row[n++] = $0; split($0, f, ","); last = f[1] + 1 }
    END { for (t = 0; t < seconds; t += last) for (i = 0; i < n; i++) {
            split(row[i], f, ","); print f[1] + t substr(row[i], index(row[i], ",")) } }' /lab/hand.csv > /tmp/hand.csv
}

# Four steps of the hand's integration a millisecond instead of 20: the simulated mechanics is most of what the guest computes.
start_device() { # ADDRESS [OPTION...]
  at=$1
  shift
  palpate-device --device "$at" --path /tmp/hand.csv --priority 70 --set "substeps=$((4 * ${period_us:-1000} / 1000))" \
    --set "period_s=$(awk -v us="${period_us:-1000}" 'BEGIN { print us * 1e-6 }')" "$@" & device=$!
}

# latched NAME TICKS: this fault ended the run, after at least so many ticks (an earlier one would be another fault's).
latched() {
  [ "$status" -eq 5 ]  # kExitFault
  grep -q "^FAULT *$1:" /results/log.txt
  awk -v least="$2" '/^controller:/ { if ($2 >= least) good = 1 } END { exit !good }' /results/log.txt
}

# Processes started and killed, files written, and the host itself stopped for 1.2 s out of every 4 s; FILE: its process.
disturb() {
  while sleep 2.5; do
    host=$(pidof lab_host palpate) || break
    (while :; do :; done) & burner=$!
    dd if=/dev/zero of=/tmp/blob bs=1M count=4 2> /dev/null
    sleep 0.03
    kill -KILL $burner
    kill -STOP $host 2> /dev/null || break
    sleep 1.2
    kill -CONT $host 2> /dev/null || break
  done
}

# The controller has lost its host: it says so, and ends by itself.
ends_alone() {
  for i in 1 2 3 4 5 6 7 8 9 10; do pidof palpate-rt > /dev/null || return 0; sleep 0.5; done
  return 1
}

# render CONTROLLER_ADDRESS DEVICE_ADDRESS [DEVICE OPTION...]: runs ellipsoid_mallet with the simulated device on the
# other end and prints the summary. Up to 20 s with an ordinary host, which records; the recording is replayed outside.
# Longer runs have a hostile host, amid processes that come and go; it is stopped, floods the controller, and is killed.
render() {
  controller_at=$1
  shift
  measure_kernel
  repeat_hand
  start_device "$@"
  if [ "$seconds" -gt 20 ]; then render_hostile; else render_recorded; fi
}

# `palpate doctor --device` must find the device, which sends on after the run; the scenario says as what, in `found`.
find_device() {
  [ -n "${found:-}" ] || return 0
  palpate doctor --device > /results/found.txt || true
  grep -q "^pass *$found" /results/found.txt
}

render_recorded() {
  status=0
  # shellcheck disable=SC2086  # an address, or the options of two
  palpate run "$image" --device $controller_at --profile "$profile" --duration "$seconds" --record /tmp/run.plr \
    --priority 80 --quiet || status=$?
  find_device
  kill $device 2> /dev/null || true
  palpate latency --recording /tmp/run.plr --histfile /results/latency.txt --json /results/latency.json \
    --overlay /results/cyclictest.txt --plot /results/latency.svg || true
  sha256sum < /tmp/run.plr | cut -c1-64 > /results/recording.sha256
  cp /tmp/run.plr /results/
  return $status
}

render_hostile() {
  disturb & chaos=$!
  lab_host "$image" "$controller_at" "$profile" "$seconds" 30 /results || [ $? -eq 137 ]
  kill $chaos 2> /dev/null || true
  ends_alone
  kill $device
  grep -q '^controller: .* faults 0x100$' /results/log.txt  # HostSilent and nothing else
}
