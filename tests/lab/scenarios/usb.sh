# USB: a vendor-defined HID device through the kernel's real USB stack; controller on hidraw, device on the gadget side.
. /lab/scenarios/common.sh
raise 'irq/*' 85
raise_usb
found='usb:/dev/hidraw0: open node'
render usb:/dev/hidraw0 usb:/dev/hidg0
