# Three simulated ODrives of an arm on vcan, classic frames.
. /lab/scenarios/common.sh
profile=/lab/devices/example-arm-odrive.toml
found='can:vcan0: ODrive '
render can:vcan0 can:vcan0 --profile "$profile"
