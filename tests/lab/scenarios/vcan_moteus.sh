# Three simulated moteus controllers of an arm on vcan, FD frames, identifiers of 29 bits.
. /lab/scenarios/common.sh
profile=/lab/devices/example-arm-moteus.toml
render can:vcan0 can:vcan0 --profile "$profile"
