// Lists of tool poses: read from a CSV file, or made from a scripted path by interpolation.
#pragma once

#include <istream>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.h"
#include "rt_core/io.h"

namespace palpate {

struct TimedPose {
  double time_s = 0;
  Pose tool_w;
  JointCommand joints = {};  // of an articulated tool
};

// Reads a table with a header row. Columns, in any order: x_mm, y_mm, z_mm; optionally time_s (strictly increasing);
// optionally either rx_deg, ry_deg, rz_deg (rotation vector) or qw, qx, qy, qz (unit to 1e-3); optionally closing (of
// all fingers, 0 to 1). Blank lines and lines
// that start with # are skipped. Without time_s, row n gets n * period_s. Throws std::runtime_error "NAME:LINE: COLUMN:
// what is wrong; what is allowed".
std::vector<TimedPose> read_poses(std::istream& text, const std::string& name, double period_s);
std::vector<TimedPose> read_pose_file(const std::string& path, double period_s);

// One pose per period from the first to the last time: positions linear, orientations by the shortest rotation.
std::vector<TimedPose> resample(std::span<const TimedPose> poses, double period_s);
// The motion a scene scripts for its simulated hand, one pose per period: minimum-jerk moves between its points.
std::vector<TimedPose> scripted_poses(const PathDesc& path, double period_s);

}  // namespace palpate
