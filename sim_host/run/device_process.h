// The simulated device as a child process, connected to the controller by a socket pair.
#pragma once

#include <string>

#include "hal/device/device_sim.h"
#include "sim_host/bake/scene_image.h"
#include "sim_host/run/process.h"
#include "sim_host/run/socket_pair.h"

namespace palpate {

// A simulated device stands for hardware, which nothing delays; but the controller comes first.
inline constexpr int kDevicePriorityBelow = 10;

class DeviceProcess {
 public:
  // `path`: CSV of the hand's motion; empty: the scene's own. Throws std::runtime_error when there is neither.
  // `priority`: SCHED_FIFO of the device, below the controller's; 0: ordinary scheduling. `turn_fd` >= 0: virtual time
  // in lock step with the controller at the other end. `hand_fd` >= 0: memory that says where the hand is pulled
  // (rings/hand_target.h). `profile`: of a device with drives, which it then simulates; or empty.
  DeviceProcess(const std::string& program, const SceneImage& scene, const std::string& path, const std::string& device,
                int priority, int turn_fd = -1, int hand_fd = -1, const std::string& profile = "");
  ~DeviceProcess();
  DeviceProcess(const DeviceProcess&) = delete;
  DeviceProcess& operator=(const DeviceProcess&) = delete;

  bool running() { return process_.running(); }
  bool ends_within(int timeout_ms) { return process_.wait(timeout_ms); }
  int controller_end() const { return sockets_.end(0); }
  // Once the controller holds it: then the device notices the controller's end.
  void close_controller_end() { sockets_.close_end(0); }

 private:
  SocketPair sockets_;
  Process process_;
};

// The hand's motion of a scene as the CSV palpate-device reads (see hand_path_file.h): its path, or the one on which a
// hand that holds the body lets it see the tool on that path.
std::string path_csv(const SceneDesc& scene);
// The scene's device and hand.
PlantOptions plant_of(const SceneDesc& scene);
// Their properties as palpate-device takes them: --set NAME=VALUE...
std::vector<std::string> plant_arguments(const SceneDesc& scene);

}  // namespace palpate
