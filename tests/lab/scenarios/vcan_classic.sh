# Classic frames on vcan.
. /lab/scenarios/common.sh
render can:vcan0,classic can:vcan0,classic --bus-model classic
