# The buses themselves, before Palpate uses them: frames through vcan and the two SJA1000 cards, a report through USB HID.
ls -l /dev/hidg0 /dev/hidraw0
for pair in "vcan0 vcan0" "can0 can1"; do
  set -- $pair
  candump -n 3 -T 2000 "$2" > /tmp/seen & sleep 0.1
  cangen "$1" -g 1 -n 3 -L 8; wait
  [ "$(wc -l < /tmp/seen)" -eq 3 ] && echo "$1 -> $2: 3 frames"
done
head -c 65 /dev/zero > /dev/hidraw0  # report number 0, then 64 bytes
[ "$(dd if=/dev/hidg0 bs=64 count=1 2>/dev/null | wc -c)" -eq 64 ] && echo "hidraw0 -> hidg0: 64 bytes"
