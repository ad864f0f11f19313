# Faults of the device while the controller renders: short ones pass, and a long silence at the end latches.
. /lab/scenarios/common.sh
cat > /tmp/faults.txt << 'END'
2.0 lose 1
2.5 lose 2
3.0 lose 5
3.5 duplicate 5
4.0 reorder 3
4.5 delay 4
5.0 corrupt 3
5.5 sequence
6.0 restart 0.010
6.5 drift 500
7.0 freeze 0.05
7.5 unplug 0.012
8.0 silence 0.2
END
status=0
render can:vcan0 can:vcan0 --faults /tmp/faults.txt || status=$?
latched DeviceSilent 7900
