# Host processes burn the processor and write files all the time, the host is stopped and continued, its command region
# is flooded without a pause, and in the end the host is killed: the controller keeps every deadline, then ends by itself.
. /lab/scenarios/common.sh
measure_kernel
repeat_hand
start_device can:vcan0
for i in 1 2 3 4; do while :; do :; done & burners="$burners $!"; done
while :; do dd if=/dev/zero of=/tmp/blob bs=1M count=64 2> /dev/null; done & burners="$burners $!"
(sleep 1.5; while host=$(pidof palpate); do kill -STOP $host; sleep 1.2; kill -CONT $host; sleep 0.3; done) & chaos=$!
palpate run "$image" --device can:vcan0 --profile "$profile" --duration "$seconds" --record /tmp/run.plr --priority 80 --quiet --allow lost=100
kill $chaos $device
palpate replay /tmp/run.plr || true  # a stopped recorder loses records; the controller loses nothing
echo "== flooded and killed"
start_device can:vcan0
lab_host "$image" can:vcan0 "$profile" 4 4000 /results || [ $? -eq 137 ]
ends_alone
kill $device $burners
grep -q '^controller: .* faults 0x100$' /results/log.txt  # HostSilent and nothing else
