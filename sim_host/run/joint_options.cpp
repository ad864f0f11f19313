// The joint options that `run` and `press` share.
#include <CLI/CLI.hpp>

#include "sim_host/cli.h"
#include "sim_host/run/joint_script.h"

namespace palpate {

void add_joint_options(CLI::App& command, JointOptions& options) {
  command
      .add_option("--close", options.close,
                  "how far the fingers (or jaws) close, 0 to 1: one number for all, or five, thumb first, as "
                  "1,0.8,0,0,0. When: as the motion closes them; from the beginning if it does not")
      ->delimiter(',');
  command
      .add_option("--joint", options.joint,
                  "where one joint goes, as index_flexion=30, in degrees (gripper: jaw0=5, in mm); may be repeated. "
                  "Joints of a hand: thumb_root_spread, thumb_root_flexion, thumb_spread, thumb_flexion, "
                  "thumb_tip_flexion; of the other fingers: index_spread, index_flexion, index_middle_flexion, "
                  "index_tip_flexion, middle_..., ring_..., little_...")
      ->take_all();
  command.add_option("--joints", options.table,
                     "commands by time, CSV: time_s and any of closing, thumb, index, middle, ring, little (0 to 1) "
                     "and joint names (degrees or mm)");
}

}  // namespace palpate
