# The kernel's own wake-up latency: what every other scenario is compared with.
. /lab/scenarios/common.sh
measure_kernel $((seconds * 1000))
tail -n 12 /results/cyclictest.txt
