# 2,000 ticks a second: CAN FD frames on vcan.
period_us=500
. /lab/scenarios/common.sh
image=/lab/scenes/mallet_2khz.pal
render can:vcan0 can:vcan0 --bus-model fd
