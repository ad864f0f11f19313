# Three simulated ODrives of an arm on vcan, classic frames.
. /lab/scenarios/common.sh
profile=/lab/devices/example-arm-odrive.toml
render can:vcan0 can:vcan0 --profile "$profile"
