# scene_NAME: a scene of config/scenes along its own path, with its own device and hand, CAN FD frames on vcan.
. /lab/scenarios/common.sh
measure_kernel
cp "/lab/scenes/$scene.csv" /tmp/hand.csv
# shellcheck disable=SC2046  # options, one a word
start_device can:vcan0 $(cat "/lab/scenes/$scene.args") --bus-model fd
image=/lab/scenes/$scene.pal
profile=/lab/devices/$(cat "/lab/scenes/$scene.device").toml
controller_at=can:vcan0
render_recorded
