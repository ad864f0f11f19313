# CAN FD frames on vcan: simulated device at a lower priority than the controller, host recording.
. /lab/scenarios/common.sh
render can:vcan0 can:vcan0 --bus-model fd
