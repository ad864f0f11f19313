// The motion of the simulated hand as a CSV file: time_s,x_mm,y_mm,z_mm[,rx_deg,ry_deg,rz_deg], one pose per row. The
// rotation is a rotation vector (axis times angle), world frame. Empty lines, lines starting with '#' and one line of
// column names are skipped.
#pragma once

#include <string>
#include <vector>

#include "hal/device/hand_path.h"

namespace palpate {

// False, with `error` naming file, line and what is wrong, when the file is not such a table.
bool read_hand_path(const std::string& path, std::vector<HandPose>& poses, std::string& error);

}  // namespace palpate
