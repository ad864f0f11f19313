// The second device of a run with two hands (device.holds = "both" or "two_tools"): simulated beside the first one, or
// named.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/model.h"
#include "sim_host/bake/scene_image.h"
#include "sim_host/run/device_process.h"
#include "sim_host/run/run_session.h"
#include "sim_host/run/socket_pair.h"

namespace palpate {

class SecondHand {
 public:
  // Nothing where one hand moves the scene. `program`: palpate-device. Throws std::runtime_error where the options do
  // not go with the scene.
  SecondHand(const RunOptions& options, const ModelParams& params, const SceneImage& scene, const std::string& program,
             bool virtual_time);
  // What the controller needs of it: arguments, and descriptors to hand over (ControllerLink).
  void add_to(std::vector<std::string>& arguments, std::vector<std::pair<int, int>>& descriptors) const;
  // Once the controller holds them.
  void close_controller_ends();

 private:
  std::string address_;  // empty: no second hand
  std::optional<SocketPair> turns_;
  std::optional<DeviceProcess> device_;
};

}  // namespace palpate
