// The simulated device and hand of a scene, as `palpate run` starts them: same plant, same path, same wire.
#pragma once

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "config/scene/scene.h"
#include "hal/bus/device_bus.h"
#include "hal/bus/loopback.h"
#include "hal/device/device_node.h"
#include "sim_host/run/device_process.h"
#include "sim_host/run/hand_path_file.h"

namespace palpate::test {

inline HandPath path_of(const SceneDesc& scene) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("palpate_path_" + std::to_string(getpid()) + ".csv");
  std::ofstream(file) << path_csv(scene);
  std::vector<HandPose> poses;
  std::string error;
  const bool read = read_hand_path(file.string(), poses, error);
  std::filesystem::remove(file);
  if (!read) throw std::runtime_error(error);
  return HandPath(std::move(poses));
}

// A Device in virtual time: each receive() first lets the node live up to the clock.
class SceneHand {
 public:
  SceneHand(const SceneDesc& scene, const VirtualClock& clock)
      : clock_(clock), ends_(open_loopback_pair(error_)), period_ns_(std::llround(1e9 * scene.device.period_s)) {
    if (!ends_.first) throw std::runtime_error(error_);
    node_ = std::make_unique<DeviceNode>(*ends_.second, NodeOptions{}, plant_of(scene), path_of(scene));
    bus_ = std::make_unique<DeviceBus>(*ends_.first, WireProfile::kFd);
    due_ns_ = period_ns_;
  }
  void receive(DeviceSample& sample) noexcept {
    for (; due_ns_ <= clock_.now_ns(); due_ns_ += period_ns_) node_->step(due_ns_);
    bus_->receive(sample);
  }
  bool transmit(const DeviceCommand& command) noexcept { return bus_->transmit(command); }

 private:
  const VirtualClock& clock_;
  std::string error_;
  std::pair<std::unique_ptr<Transport>, std::unique_ptr<Transport>> ends_;
  std::unique_ptr<DeviceNode> node_;
  std::unique_ptr<DeviceBus> bus_;
  std::int64_t period_ns_, due_ns_ = 0;
};
struct ArmedHost {
  std::uint32_t poll() noexcept { return Command::kArm; }
};
struct NoSink {
  void publish(const TickRecord&) noexcept {}
};

}  // namespace palpate::test
