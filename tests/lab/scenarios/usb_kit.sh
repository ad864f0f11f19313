# The Python device kit as a USB device: docs/examples/device_kit.py on the gadget side of the kernel's real USB stack.
. /lab/scenarios/common.sh
raise 'irq/*' 85
raise_usb
found='usb:/dev/hidraw0: open node'
controller_at=usb:/dev/hidraw0
measure_kernel
PYTHONHOME=/lab/kit chrt -f 70 python3 -B /lab/kit/device_kit.py usb:/dev/hidg0 & device=$!
sleep 2 # until Python has compiled its modules
render_recorded
