#include "sim_host/run/second_hand.h"

#include <algorithm>
#include <stdexcept>

#include "sim_host/run/controller_link.h"

namespace palpate {

namespace {

// The scene as the second hand has it, by the same device and as firmly as the first: it moves a tool of its own, or
// holds the body where the scene has it.
SceneImage of_second_hand(const SceneImage& scene) {
  SceneImage second = scene;
  if (!second.scene) return second;
  PathPoint still;
  still.position_m = second.scene->device.grip_m;
  const bool two_tools = second.scene->device.holds == HeldPart::kTwoTools;
  second.scene->path.point = two_tools ? scene.scene->path.second : std::vector{still};
  return second;
}

}  // namespace

SecondHand::SecondHand(const RunOptions& options, const ModelParams& params, const SceneImage& scene,
                       const std::string& program, bool virtual_time) {
  const bool asked = !options.second_device.empty() || !options.second_path.empty();
  if (!has_two_devices(params.held_part)) {
    if (asked)
      throw std::runtime_error(
          "--second-device, --second-path: one hand moves this scene; bake it with device.holds = \"both\" or "
          "\"two_tools\"");
    return;
  }
  address_ = options.second_device.empty() ? "loopback" : options.second_device;
  if (address_ != "loopback") {
    if (virtual_time || !options.second_path.empty())
      throw std::runtime_error("--second-device " + address_ +
                               ": has its own time and hand; use --real-time, without --second-path");
    return;
  }
  if (virtual_time) turns_.emplace();
  const int priority = virtual_time ? 0 : std::max(0, options.priority - kDevicePriorityBelow);
  device_.emplace(program, of_second_hand(scene), options.second_path, address_, priority,
                  virtual_time ? turns_->end(1) : -1);
}

void SecondHand::add_to(std::vector<std::string>& arguments, std::vector<std::pair<int, int>>& descriptors) const {
  if (address_.empty()) return;
  arguments.insert(arguments.end(), {"--second-device", address_});
  if (!device_) return;
  arguments.insert(arguments.end(), {"--second-fd", std::to_string(ControllerLink::kSecondDescriptor)});
  descriptors.emplace_back(device_->controller_end(), ControllerLink::kSecondDescriptor);
  if (!turns_) return;
  arguments.insert(arguments.end(), {"--second-turn-fd", std::to_string(ControllerLink::kSecondTurnDescriptor)});
  descriptors.emplace_back(turns_->end(0), ControllerLink::kSecondTurnDescriptor);
}

void SecondHand::close_controller_ends() {
  if (device_) device_->close_controller_end();
  turns_.reset();
}

}  // namespace palpate
