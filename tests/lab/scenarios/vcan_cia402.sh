# Three simulated CiA 402 drives of a delta on vcan, classic frames.
. /lab/scenarios/common.sh
profile=/lab/devices/example-delta-cia402.toml
render can:vcan0 can:vcan0 --profile "$profile"
