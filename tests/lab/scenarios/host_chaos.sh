# Host processes burn the processor and write files, the host is stopped and continued, its command region is flooded
# with commands, and in the end the host is killed: the controller keeps every deadline and then
# ends by itself.
. /lab/scenarios/common.sh
measure_kernel
repeat_hand
start_device can:vcan0
for i in 1 2 3 4; do while :; do :; done & burners="$burners $!"; done
while :; do dd if=/dev/zero of=/tmp/blob bs=1M count=64 2> /dev/null; done & burners="$burners $!"
(sleep 1.5; while host=$(pidof palpate); do kill -STOP $host; sleep 1.2; kill -CONT $host; sleep 0.3; done) & chaos=$!
status=0
palpate run /lab/ellipsoid_mallet.pal --device can:vcan0 --duration "$seconds" --record /tmp/run.plr --priority 80 \
  --quiet || status=$?
kill $chaos $device
palpate replay /tmp/run.plr || true  # a stopped recorder loses records; the controller loses nothing
echo "== flooded"
start_device can:vcan0
lab_flood /lab/ellipsoid_mallet.pal can:vcan0 3 || status=$?
kill $device
echo "== killed"
start_device can:vcan0
palpate run /lab/ellipsoid_mallet.pal --device can:vcan0 --duration 60 --no-record --priority 80 --quiet & host=$!
sleep 3
kill -KILL $host
for i in 1 2 3 4 5 6 7 8 9 10; do pidof palpate-rt > /dev/null || break; sleep 0.5; done
! pidof palpate-rt
kill $device $burners
exit $status
