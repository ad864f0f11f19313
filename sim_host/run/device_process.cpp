#include "sim_host/run/device_process.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "rt_core/tool/held_body.h"
#include "sim_host/bake/default_path.h"
#include "sim_host/bake/image_file.h"
#include "sim_host/run/plant_options.h"

namespace palpate {

namespace {

constexpr int kDeviceEnd = 3;  // descriptors in the child
constexpr int kPathFile = 4;
constexpr int kTurns = 5;
constexpr int kHand = 6;
constexpr double kDegreesPerRadian = 180.0 / 3.14159265358979323846;

// Closes a descriptor at the end of its scope.
struct Descriptor {
  explicit Descriptor(int number) : fd(number) {}
  ~Descriptor() {
    if (fd >= 0) close(fd);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int fd;
};

// An unnamed file with this text, which leaves nothing behind.
int text_file(const std::string& text) {
  const int fd = memfd_create("palpate-path", MFD_CLOEXEC);
  if (fd < 0 || write(fd, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw std::runtime_error(fmt::format("cannot pass the path to the simulated device: {}", std::strerror(errno)));
  }
  return fd;
}

}  // namespace

std::string path_csv(const SceneDesc& scene) {
  std::string text = "time_s,x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg,closing\n";
  double closing = 0;
  for (const PathPoint& point : scene.path.point) {
    Pose hand{point.position_m, rotation_by(point.rotation_rad)};
    Vec3 turn_rad = point.rotation_rad;
    if (scene.device.holds == HeldPart::kBody) {
      hand = handle_seeing(scene.device.grip_m, hand);
      turn_rad = -turn_rad;
    }
    const Vec3 p = 1e3 * hand.position_m, r = kDegreesPerRadian * turn_rad;
    if (!point.closing.empty()) closing = *std::ranges::max_element(point.closing);
    text += fmt::format("{},{},{},{},{},{},{},{}\n", point.time_s, p.x, p.y, p.z, r.x, r.y, r.z, closing);
  }
  return text;
}

namespace {

// Of the scene; where only its image is known, the one that every body can take.
std::string motion_csv(const SceneImage& scene) {
  if (scene.scene && scene.scene->path.point.empty())
    throw std::runtime_error("the simulated hand needs a motion: give --path CSV, or the scene a [path]");
  if (scene.scene) return path_csv(*scene.scene);
  const ImageFile image(scene.image_path);
  const ModelParams& params = image.model().params;
  SceneDesc described;
  described.path = path_of_image(image.model());
  described.device.holds = params.held_part;
  described.device.grip_m = {params.grip_x_m, params.grip_y_m, params.grip_z_m};
  fmt::print("        an image holds no motion: the hand presses the body's highest point and slides along x\n");
  return path_csv(described);
}

}  // namespace

PlantOptions plant_of(const SceneDesc& scene) {
  const DeviceDesc& device = scene.device;
  const PathDesc& hand = scene.path;
  PlantOptions plant;
  plant.mass_kg = device.mass_kg;
  plant.damping_N_s_per_m = device.damping_Ns_per_m;
  plant.friction_N = device.friction_N;
  plant.inertia_kg_m2 = device.inertia_kg_m2;
  plant.damping_Nm_s_per_rad = device.damping_Nms_per_rad;
  plant.friction_Nm = device.friction_Nm;
  plant.encoder_m = device.encoder_step_m;
  plant.local_Hz = device.local_Hz;
  plant.force_max_N = device.force_max_N;
  plant.torque_max_Nm = device.torque_max_Nm;
  plant.hand_stiffness_N_per_m = hand.hand_stiffness_N_per_m;
  plant.hand_damping_N_s_per_m = hand.hand_damping_Ns_per_m;
  plant.hand_stiffness_Nm_per_rad = hand.hand_stiffness_Nm_per_rad;
  plant.hand_damping_Nm_s_per_rad = hand.hand_damping_Nms_per_rad;
  plant.period_s = device.period_s;
  plant.delay_ticks =
      static_cast<int>(std::clamp(std::round(device.delay_s / device.period_s), 0.0, 1.0 * kMaxDelayTicks));
  return plant;
}

std::vector<std::string> plant_arguments(const SceneDesc& scene) {
  const PlantOptions plant = plant_of(scene);
  std::vector<std::string> arguments;
  const auto set = [&](const char* name, auto value) {
    arguments.insert(arguments.end(), {"--set", fmt::format("{}={}", name, value)});
  };
#define PALPATE_SET(member) set(#member, plant.member);
  PALPATE_PLANT_OPTIONS(PALPATE_SET)
#undef PALPATE_SET
  set("delay_ticks", plant.delay_ticks);
  return arguments;
}

DeviceProcess::DeviceProcess(const std::string& program, const SceneImage& scene, const std::string& path,
                             const std::string& device, int priority, int turn_fd, int hand_fd,
                             const std::string& profile) {
  const Descriptor file(path.empty() ? text_file(motion_csv(scene)) : -1);
  std::vector<std::string> arguments{
      "--device", device, "--device-fd", std::to_string(kDeviceEnd), "--priority", std::to_string(priority)};
  std::vector<std::pair<int, int>> descriptors{{sockets_.end(1), kDeviceEnd}};
  if (file.fd >= 0) descriptors.emplace_back(file.fd, kPathFile);
  arguments.insert(arguments.end(), {"--path", file.fd >= 0 ? fmt::format("/proc/self/fd/{}", kPathFile) : path});
  if (scene.scene) {
    const std::vector<std::string> plant = plant_arguments(*scene.scene);
    arguments.insert(arguments.end(), plant.begin(), plant.end());
  } else {  // an image says nothing of the plant but how often it is asked
    const double period_s = ImageFile(scene.image_path).model().params.period_s;
    arguments.insert(arguments.end(), {"--set", fmt::format("period_s={}", period_s)});
  }
  if (!profile.empty()) arguments.insert(arguments.end(), {"--profile", profile});
  if (turn_fd >= 0) {
    descriptors.emplace_back(turn_fd, kTurns);
    arguments.insert(arguments.end(), {"--turn-fd", std::to_string(kTurns)});
  }
  if (hand_fd >= 0) {
    descriptors.emplace_back(hand_fd, kHand);
    arguments.insert(arguments.end(), {"--hand-fd", std::to_string(kHand)});
  }
  process_ = Process::start(program, arguments, descriptors);
  sockets_.close_end(1);
}

DeviceProcess::~DeviceProcess() {
  close_controller_end();
  process_.signal(SIGTERM);
  process_.wait(500);  // then Process's destructor insists
}

}  // namespace palpate
