# The USB device is pulled out in the middle of a press: the bus says so, the fault latches.
. /lab/scenarios/common.sh
raise 'irq/*' 85
raise_usb
(sleep 6; echo > /sys/kernel/config/usb_gadget/palpate/UDC) &
status=0
render usb:/dev/hidraw0 usb:/dev/hidg0 || status=$?
latched DeviceSilent 3000
