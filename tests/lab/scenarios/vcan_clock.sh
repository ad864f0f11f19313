# A device on vcan whose clock is 400 ppm slow: the loop follows it, and no tick is without a sample.
. /lab/scenarios/common.sh
echo '0 drift -400' > /tmp/slow.txt
render can:vcan0 can:vcan0 --faults /tmp/slow.txt
grep -qE '^device clock: -(39|40)[0-9] ppm, followed; phase at most 0\.0' /results/log.txt
grep -q '^controller: .* 0 without a fresh sample' /results/log.txt
