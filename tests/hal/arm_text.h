// A device of three drives, as the tables of its profile.
#pragma once

#include <string>

namespace palpate::test {

// After Forsslund et al. 2015 (WoodenHaptics): links of 205 and 245 mm, bodies of 160 and 120 mm on capstans of 10 mm.
inline constexpr char kArm[] = R"(
[frame]
position_x_mm = -100
turn_z_deg = 90
scale = 2
clutch_button = 2
[linkage]
kind = "serial_3r"
calibrate = "home_pose"
upper_mm = 205
fore_mm = 245
weight_z_N = -0.5
[drives]
protocol = "odrive"
firmware = "0.6.10"
watchdog_ms = 20
endpoint_enable_watchdog = 182
endpoint_watchdog_timeout = 183
endpoint_direction = 396
[[axis]]
node = 1
serial = 61925406831665
counts_per_turn = 8192
ratio = 16
direction = 1
home_deg = 0
lowest_deg = -60
highest_deg = 60
torque_max_Nm = 0.1
[[axis]]
node = 2
serial = 61925406831666
counts_per_turn = 8192
ratio = 12
direction = -1
home_deg = 80
lowest_deg = 10
highest_deg = 120
torque_max_Nm = 0.1
gravity_Nm = 0.2
[[axis]]
node = 3
serial = 61925406831667
counts_per_turn = 8192
ratio = 12
direction = 1
home_deg = -20
lowest_deg = -90
highest_deg = 40
torque_max_Nm = 0.1
)";

}  // namespace palpate::test
