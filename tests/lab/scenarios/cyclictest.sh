# The kernel's own wake-up latency: what every other scenario is compared with.
cyclictest -m -p 90 -i 1000 -l 20000 -q -t 1 -h 100 > /results/cyclictest.txt
tail -n 12 /results/cyclictest.txt
