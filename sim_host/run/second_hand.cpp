#include "sim_host/run/second_hand.h"

#include <algorithm>
#include <stdexcept>

#include "sim_host/run/controller_link.h"

namespace palpate {

namespace {

// A hand that holds the body where the scene has it, by the same device and as firmly as the first.
SceneImage holding_still(const SceneImage& scene) {
  SceneImage still = scene;
  if (!still.scene) return still;
  PathPoint point;
  point.position_m = still.scene->device.grip_m;
  still.scene->path.point = {point};
  return still;
}

}  // namespace

SecondHand::SecondHand(const RunOptions& options, const ModelParams& params, const SceneImage& scene,
                       const std::string& program, bool virtual_time) {
  const bool asked = !options.second_device.empty() || !options.second_path.empty();
  if (params.held_part != HeldPart::kBoth) {
    if (asked)
      throw std::runtime_error(
          "--second-device, --second-path: one hand moves this scene; bake it with device.holds = \"both\"");
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
  device_.emplace(program, holding_still(scene), options.second_path, address_, priority,
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
