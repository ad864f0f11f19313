# The same with classic frames on vcan.
. /lab/scenarios/common.sh
render can:vcan0,classic can:vcan0,classic "${SECONDS_TO_RUN:-10}"
