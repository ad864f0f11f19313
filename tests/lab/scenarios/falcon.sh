# A simulated Novint Falcon through the kernel's real USB stack: controller on usbfs, device on FunctionFS.
. /lab/scenarios/common.sh
raise 'irq/*' 85
raise_usb
image=/lab/scenes/falcon.pal
profile=/lab/devices/example-falcon.toml
# In the HID device's place: maker and product of the Falcon's serial adapter. It is plugged in once the simulation has
# described it.
gadgets=/sys/kernel/config/usb_gadget
echo > $gadgets/palpate/UDC
mkdir $gadgets/falcon
cd $gadgets/falcon
echo 0x0403 > idVendor
echo 0xcb48 > idProduct
mkdir functions/ffs.falcon configs/c.1
ln -s functions/ffs.falcon configs/c.1/
mkdir /tmp/falcon
mount -t functionfs falcon /tmp/falcon
(
  until [ -e /tmp/falcon/ep2 ]; do sleep 0.05; done
  sleep 0.2
  ls /sys/class/udc > UDC
) &
cd /lab
# The address is known once it is plugged in.
address() {
  for i in 1 2 3 4 5 6 7 8 9 10; do
    for device in /sys/bus/usb/devices/*; do
      [ "$(cat "$device/idProduct" 2> /dev/null)" = cb48 ] || continue
      printf 'usb:/dev/bus/usb/%03d/%03d' "$(cat "$device/busnum")" "$(cat "$device/devnum")"
      return
    done
    sleep 0.2
  done
}
measure_kernel
repeat_hand
start_device usb:/tmp/falcon --profile "$profile"
sleep 1
controller_at=$(address)
[ -n "$controller_at" ]
found="$controller_at: Novint Falcon"
if [ "$seconds" -gt 20 ]; then render_hostile; else render_recorded; fi
