# Classic CAN at 1 Mbit/s between two emulated SJA1000 cards: the kernel's real driver with threaded interrupts. The
# interrupt threads run above the loop, as palpate doctor asks.
. /lab/scenarios/common.sh
raise 'irq/*' 85
render can:can0,classic can:can1,classic
