#include "sim_host/doctor/certify.h"

#include <fmt/format.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "sim_host/bake/image_file.h"
#include "sim_host/bake/scene_image.h"
#include "sim_host/run/host_load.h"
#include "sim_host/status_text.h"

namespace palpate {

namespace {

// A ball pressed, stroked and left again, so that ticks with and without contact are measured.
constexpr char kBuiltInScene[] = R"(
name = "certify"
[body]
shape = "sphere"
radius_mm = 30
triangles = 5000
[[tool.piece]]
shape = "sphere"
radius_mm = 8
[[path.point]]
time_s = 0
position_mm = [0, 80, 0]
[[path.point]]
time_s = 1
position_mm = [0, 66, 0]
[[path.point]]
time_s = 3
position_mm = [20, 62, 0]
[[path.point]]
time_s = 4
position_mm = [0, 80, 0]
)";

// A folder of our own for the image, gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "palpate-certify-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot create " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const char* name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

RunOptions run_options(const CertifyOptions& options, const TemporaryFolder& folder) {
  RunOptions run;
  run.scene = options.scene;
  if (run.scene.empty()) {
    run.scene = folder.file("certify.toml");
    std::ofstream(run.scene) << kBuiltInScene;
  }
  run.image = folder.file("certify.pal");
  run.device = options.device;
  run.profile = options.profile;
  run.duration_s = options.duration_s;
  run.record.clear();
  run.path = options.path;
  run.cpu = options.cpu;
  run.priority = options.priority;
  run.quiet = true;
  run.arm = false;
  run.repeat_path = true;
  run.black_box = options.out;
  run.progress = options.progress;
  run.program_folder = options.program_folder;
  return run;
}

}  // namespace

HostCertificate certify(const CertifyOptions& options) {
  HostCertificate certificate;
  certificate.options = options;
  DoctorSources sources = this_machine();
  sources.cpu = options.cpu;
  sources.loop_priority = options.priority;
  certificate.machine = identify_machine(sources, options.device);
  certificate.start_s = std::time(nullptr);
  if (certificate.options.out.empty()) {
    certificate.options.out = certificate_name(certificate.machine.host, certificate.start_s);
  }
  const TemporaryFolder folder;
  const RunOptions run = run_options(certificate.options, folder);
  {
    std::optional<HostLoad> load;
    if (options.host_load) load.emplace(folder.path());
    certificate.run = run_session(run);
  }
  certificate.end_s = std::time(nullptr);
  const bool baked = std::filesystem::path(run.scene).extension() == ".toml";
  const ImageFile image(baked ? run.image : run.scene);
  certificate.period_ns = static_cast<std::int64_t>(image.model().params.period_s * 1e9 + 0.5);
  judge(certificate);
  return certificate;
}

void judge(HostCertificate& certificate) {
  const RunResult& run = certificate.run;
  const RunSummary& s = run.summary;
  const CertifyLimits& limits = certificate.options.limits;
  std::vector<std::string>& reasons = certificate.reasons;
  reasons.clear();
  const auto us = [](std::int64_t ns) { return 1e-3 * static_cast<double>(ns); };
  const double busy_limit_us = limits.busy_share * us(certificate.period_ns);
  if (s.ticks == 0) reasons.emplace_back("no ticks were measured");
  if (s.missed_ticks > 0) reasons.push_back(fmt::format("{} deadlines missed, none allowed", s.missed_ticks));
  if (us(s.busy.max_ns) > busy_limit_us) {
    reasons.push_back(fmt::format("longest tick {:.1f} us, {:.1f} us allowed (tick {})", us(s.busy.max_ns),
                                  busy_limit_us, s.busy.cycle_of_max));
  }
  if (limits.wake_us > 0 && us(s.wake.max_ns) > limits.wake_us) {
    reasons.push_back(fmt::format("latest wake-up {:.1f} us, {:g} us allowed (tick {})", us(s.wake.max_ns),
                                  limits.wake_us, s.wake.cycle_of_max));
  }
  if (s.fault != 0) reasons.push_back("fault latched: " + bit_names(fault_bit_texts(), s.fault));
  if (run.lost > 0) reasons.push_back(fmt::format("{} ticks could not be measured (records lost)", run.lost));
  if (s.device_force_max_N > 0) reasons.push_back(fmt::format("force was {:.3g} N, not zero", s.device_force_max_N));
  if (run.controller_exit != 0) reasons.push_back(fmt::format("controller exit code {}", run.controller_exit));
  const bool complete = !run.interrupted && run.elapsed_s >= certificate.options.duration_s;
  certificate.verdict = !reasons.empty() ? CertifyVerdict::kFail
                        : complete       ? CertifyVerdict::kPass
                                         : CertifyVerdict::kIncomplete;
}

std::string certificate_name(const std::string& host, std::int64_t seconds_since_1970) {
  const std::time_t time = seconds_since_1970;
  std::tm utc{};
  gmtime_r(&time, &utc);
  std::string name = "palpate-latency-";
  for (const char c : host)
    name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '-';
  return fmt::format("{}-{:04}{:02}{:02}T{:02}{:02}{:02}Z", name, utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min, utc.tm_sec);
}

}  // namespace palpate
