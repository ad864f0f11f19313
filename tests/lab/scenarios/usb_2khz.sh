# 2,000 ticks a second: USB, as in usb.
period_us=500
. /lab/scenarios/common.sh
image=/lab/scenes/mallet_2khz.pal
raise 'irq/*' 85
raise_usb
render usb:/dev/hidraw0 usb:/dev/hidg0
