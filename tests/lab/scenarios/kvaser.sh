# Classic CAN at 1 Mbit/s between two emulated SJA1000 cards: the kernel's real driver with threaded interrupts. The
# interrupt thread of the controller's card runs above the loop, as palpate doctor asks.
. /lab/scenarios/common.sh
raise_interrupts 85
render can:can0,classic can:can1,classic "${SECONDS_TO_RUN:-10}"
