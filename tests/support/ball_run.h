// A whole run in a folder of its own: a ball pressed over the loopback, by the real controller and device processes.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "sim_host/run/run_session.h"

namespace palpate {

// The ball's lowest point is the origin, y is up: the tool touches it at y = 68 mm.
inline constexpr char kBallScene[] = R"(
name = "ball"
[body]
shape = "sphere"
radius_mm = 30
triangles = 500
[[tool.piece]]
shape = "sphere"
radius_mm = 8
[path]
hand_stiffness_N_per_m = 500
[[path.point]]
time_s = 0
position_mm = [0, 75, 0]
[[path.point]]
time_s = 0.4
position_mm = [0, 65, 0]
[[path.point]]
time_s = 0.8
position_mm = [5, 65, 0]
)";

class BallRun : public testing::Test {
 protected:
  BallRun() {
    folder_ = std::filesystem::temp_directory_path() / ("palpate_run_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    options_.scene = (folder_ / "ball.toml").string();
    std::ofstream(options_.scene) << kBallScene;
    options_.device = "loopback";
    options_.priority = 0;  // works without privileges
    options_.quiet = true;
    options_.overwrite = true;  // some tests run twice
    options_.program_folder =
        (std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "bin").string();
  }
  ~BallRun() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  RunOptions options_;
};

}  // namespace palpate
