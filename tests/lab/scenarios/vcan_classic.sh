# Classic frames on vcan.
. /lab/scenarios/common.sh
found='can:vcan0: open node 1'
render can:vcan0,classic can:vcan0,classic --bus-model classic
