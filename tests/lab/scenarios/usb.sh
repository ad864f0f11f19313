# USB: a vendor-defined HID device through the kernel's real USB stack; controller on hidraw, device on the gadget side.
. /lab/scenarios/common.sh
raise_interrupts 85
render usb:/dev/hidraw0 usb:/dev/hidg0 "${SECONDS_TO_RUN:-10}"
