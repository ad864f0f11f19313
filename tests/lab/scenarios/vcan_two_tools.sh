# Two hands with a tool and a device each, on two buses, in one tick: they pinch a ring between them.
. /lab/scenarios/common.sh
image=/lab/scenes/two_tools.pal
measure_kernel
# SIGN SHIFT: in and out, over to one side and to the other, again and again; the other hand's mirror image but for the
# shift.
way() {
  awk -v sign="$1" -v shift="$2" -v seconds="$seconds" 'BEGIN { print "time_s,x_mm,y_mm,z_mm"
    for (t = 0; t <= seconds; t += 10) {
      n = split("0 75 1 59 2.5 47 3.5 47 8 47 9.5 75", p, " ")
      for (i = 1; i < n; i += 2) {
        printf "%g,%g,55,0\n", t + p[i], sign * p[i + 1]
        if (p[i] == 3.5) printf "%g,%g,55,0\n%g,%g,55,0\n", t + 5, sign * 47 + shift, t + 6.5, sign * 47 - shift
      } } }'
}
way 1 -6 > /tmp/hand.csv
way -1 -6 > /tmp/second.csv
start_device can:vcan0 --bus-model fd
first_hand=$device
palpate-device --device can:vcan1 --path /tmp/second.csv --priority 70 --set substeps=4 --bus-model fd & second_hand=$!
controller_at="can:vcan0 --second-device can:vcan1"
render_recorded || failed=$?
kill $first_hand $second_hand 2> /dev/null || true
[ "${failed:-0}" = 0 ]
