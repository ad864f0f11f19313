# The controller's chip leaves the bus in the middle of a press: latched at once.
. /lab/scenarios/common.sh
echo '4.0 bus-off' > /tmp/faults.txt
status=0
render can:vcan0 can:vcan0 --faults /tmp/faults.txt || status=$?
latched BusOff 3900
