# Two hands with a device each, on two buses, in one tick: one presses the tool into the body, the other holds the body.
. /lab/scenarios/common.sh
image=/lab/scenes/two_hands.pal
measure_kernel
repeat_hand
start_device can:vcan0 --bus-model fd
tool_hand=$device
printf 'time_s,x_mm,y_mm,z_mm\n0,0,0,0\n1000,0,0,0\n' > /tmp/still.csv
palpate-device --device can:vcan1 --path /tmp/still.csv --priority 70 --set substeps=4 --bus-model fd & body_hand=$!
controller_at="can:vcan0 --second-device can:vcan1"
render_recorded || failed=$?
kill $tool_hand $body_hand 2> /dev/null || true
[ "${failed:-0}" = 0 ]
