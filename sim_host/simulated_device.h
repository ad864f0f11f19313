// The simulated device as a child process, connected to the controller by a socket pair.
#pragma once

#include <string>

#include "sim_host/process.h"
#include "sim_host/scene_image.h"

namespace palpate {

class SimulatedDevice {
 public:
  // `path`: CSV of the hand's motion; empty: the scene's own. Throws std::runtime_error when there is neither.
  SimulatedDevice(const std::string& program, const SceneImage& scene, const std::string& path);
  ~SimulatedDevice();
  SimulatedDevice(const SimulatedDevice&) = delete;
  SimulatedDevice& operator=(const SimulatedDevice&) = delete;

  int controller_end() const { return controller_end_; }
  // Once the controller holds it: then the device notices the controller's end.
  void close_controller_end();

 private:
  int controller_end_ = -1;
  Process process_;
};

}  // namespace palpate
