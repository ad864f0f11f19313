#include "sim_host/device_process.h"

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

namespace palpate {

namespace {

constexpr int kDeviceEnd = 3;  // descriptors in the child
constexpr int kPathFile = 4;
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

std::string path_csv(const PathDesc& path) {
  std::string text = "time_s,x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg,closing\n";
  double closing = 0;
  for (const PathPoint& point : path.point) {
    const Vec3 p = 1e3 * point.position_m, r = kDegreesPerRadian * point.rotation_rad;
    if (!point.closing.empty()) closing = *std::ranges::max_element(point.closing);
    text += fmt::format("{},{},{},{},{},{},{},{}\n", point.time_s, p.x, p.y, p.z, r.x, r.y, r.z, closing);
  }
  return text;
}

std::vector<std::string> plant_arguments(const SceneDesc& scene) {
  const DeviceDesc& device = scene.device;
  const PathDesc& hand = scene.path;
  std::vector<std::string> arguments;
  const auto set = [&](const char* name, double value) {
    arguments.insert(arguments.end(), {"--set", fmt::format("{}={}", name, value)});
  };
  set("mass_kg", device.mass_kg);
  set("damping_N_s_per_m", device.damping_Ns_per_m);
  set("friction_N", device.friction_N);
  set("inertia_kg_m2", device.inertia_kg_m2);
  set("damping_Nm_s_per_rad", device.damping_Nms_per_rad);
  set("friction_Nm", device.friction_Nm);
  set("encoder_m", device.encoder_step_m);
  set("force_max_N", device.force_max_N);
  set("torque_max_Nm", device.torque_max_Nm);
  set("hand_stiffness_N_per_m", hand.hand_stiffness_N_per_m);
  set("hand_damping_N_s_per_m", hand.hand_damping_Ns_per_m);
  set("hand_stiffness_Nm_per_rad", hand.hand_stiffness_Nm_per_rad);
  set("hand_damping_Nm_s_per_rad", hand.hand_damping_Nms_per_rad);
  set("period_s", device.period_s);
  set("delay_ticks", std::clamp(std::round(device.delay_s / device.period_s), 0.0, 15.0));
  return arguments;
}

DeviceProcess::DeviceProcess(const std::string& program, const SceneImage& scene, const std::string& path,
                             const std::string& device, int priority) {
  if (path.empty() && (!scene.scene || scene.scene->path.point.empty())) {
    throw std::runtime_error("the simulated hand needs a motion: give --path CSV, or a .toml scene with a [path]");
  }
  int pair[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair) != 0) {
    throw std::runtime_error(fmt::format("socketpair: {}", std::strerror(errno)));
  }
  controller_end_ = pair[0];
  const Descriptor device_end(pair[1]);
  const Descriptor file(path.empty() ? text_file(path_csv(scene.scene->path)) : -1);
  std::vector<std::string> arguments{
      "--device", device, "--device-fd", std::to_string(kDeviceEnd), "--priority", std::to_string(priority)};
  std::vector<std::pair<int, int>> descriptors{{device_end.fd, kDeviceEnd}};
  if (file.fd >= 0) descriptors.emplace_back(file.fd, kPathFile);
  arguments.insert(arguments.end(), {"--path", file.fd >= 0 ? fmt::format("/proc/self/fd/{}", kPathFile) : path});
  if (scene.scene) {
    const std::vector<std::string> plant = plant_arguments(*scene.scene);
    arguments.insert(arguments.end(), plant.begin(), plant.end());
  }
  process_ = Process::start(program, arguments, descriptors);
}

DeviceProcess::~DeviceProcess() {
  close_controller_end();
  process_.signal(SIGTERM);
  process_.wait(500);  // then Process's destructor insists
}

void DeviceProcess::close_controller_end() {
  if (controller_end_ >= 0) close(controller_end_);
  controller_end_ = -1;
}

}  // namespace palpate
