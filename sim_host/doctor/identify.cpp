#include "sim_host/doctor/identify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "hal/device/device_sim.h"

namespace palpate {

namespace {

constexpr double kStill_m = 2e-4;   // a handle that nobody touches moves less in a quarter of a second
constexpr double kMoved_m = 3e-4;   // it has broken loose: more than any encoder's step
constexpr double kEnough_m = 6e-3;  // 200 steps of a usual encoder
constexpr int kLostMost = 3;        // samples in a row
constexpr double kSwing_Hz = 4, kChirpEnd_Hz = 20;
constexpr double kChirp_s = 3;

// Plays forces and watches. After the first `refused` nothing moves any more.
class Bench {
 public:
  Bench(const DeviceOnBench& device, const IdentifyLimits& limits) : device_(device), limits_(limits) { push(0); }

  // One period; false when the motion has ended for good.
  bool push(double force_N) {
    device_.receive(sample_);
    watch();
    const bool goes_on = refused_.empty();
    record_.period_s = device_.period_s;
    record_.position_m.push_back(sample_.position_m.x);
    record_.force_N.push_back(goes_on ? force_N : 0);
    DeviceCommand command;
    command.force_N.x = goes_on ? force_N : 0;
    command.flags = goes_on ? CommandFlag::kEnable : 0;
    command.number = number_++;
    device_.transmit(command);
    device_.wait();
    return goes_on;
  }
  bool rest(double seconds) {
    for (double t = 0; t < seconds; t += device_.period_s)
      if (!push(0)) return false;
    return true;
  }
  void begin_record() { record_ = {}; }
  const DeviceRecord& record() const { return record_; }
  double travel_m() const {
    const auto [least, most] = std::minmax_element(record_.position_m.begin(), record_.position_m.end());
    return *most - *least;
  }
  double period_s() const { return device_.period_s; }
  void refuse(const std::string& why) {
    if (refused_.empty()) refused_ = why;
  }
  const std::string& refused() const { return refused_; }

 private:
  void watch() {
    lost_ = sample_.fresh ? 0 : lost_ + 1;
    if (lost_ > kLostMost) refuse("samples stopped: check cable and power, then try again");
    if (sample_.faults != 0 || (sample_.flags & DeviceFlag::kError) != 0)
      refuse(fmt::format("the device reports an error ({}): clear it first", sample_.error_code));
    if ((sample_.flags & DeviceFlag::kStopButton) != 0) refuse("the emergency stop is pressed: release it first");
    if ((sample_.flags & DeviceFlag::kCalibrated) == 0) refuse("the device is not calibrated: calibrate it first");
    const double x = sample_.position_m.x;
    if (!std::isfinite(x)) return refuse("a position is no number: palpate device-test");
    if (number_ == 0) start_m_ = x;
    constexpr std::size_t kLag = 5;  // an encoder step in one period is no speed
    const auto& told = record_.position_m;
    const double way = told.size() < kLag ? 0 : x - told[told.size() - kLag];
    if (std::abs(way) > limits_.speed_m_per_s * device_.period_s * kLag)
      refuse(fmt::format("the handle went faster than {:g} m/s: somebody moved it, or it is too light for this",
                         limits_.speed_m_per_s));
    if (std::abs(x - start_m_) > limits_.travel_m)
      refuse(fmt::format("the handle left {:g} mm around its place: let go of it, and balance its weight",
                         1e3 * limits_.travel_m));
  }
  const DeviceOnBench& device_;
  const IdentifyLimits& limits_;
  DeviceSample sample_;
  DeviceRecord record_;
  std::string refused_;
  std::uint32_t number_ = 0;
  int lost_ = 0;
  double start_m_ = 0;
};

// Force grows slowly until the handle moves; that force, or 0.
double breaks_loose_N(Bench& bench, double most_N) {
  constexpr double kRate_N_per_s = 1;
  bench.begin_record();
  for (double force = 0; force < most_N; force += kRate_N_per_s * bench.period_s()) {
    if (!bench.push(force)) return 0;
    if (bench.travel_m() > kMoved_m) return std::max(force, 0.01);
  }
  bench.refuse(fmt::format("nothing moves under {:g} N: drives off, a brake on, or somebody holds the handle", most_N));
  return 0;
}

// A cosine from rest: a free mass swings to one side of where it was, and comes back.
bool swing(Bench& bench, double force_N, double seconds, double end_Hz) {
  constexpr double kTurn = 2 * 3.14159265358979323846;
  for (double t = 0; t < seconds; t += bench.period_s()) {
    const double turns = kSwing_Hz * t + 0.5 * (end_Hz - kSwing_Hz) * t * t / seconds;
    if (!bench.push(force_N * std::cos(kTurn * turns))) return false;
  }
  return true;
}

// The force under which the handle swings far enough to be measured, or 0.
double wide_enough_N(Bench& bench, double begin_N, double most_N) {
  for (double force = begin_N; force <= most_N; force *= 1.5) {
    bench.begin_record();
    if (!swing(bench, force, 1 / kSwing_Hz, kSwing_Hz) || !bench.rest(0.15)) return 0;
    if (bench.travel_m() > kEnough_m) return force;
  }
  bench.refuse(fmt::format("{:g} N move the handle by less than {:g} mm: somebody holds it, or it is too heavy", most_N,
                           1e3 * kEnough_m));
  return 0;
}

std::string line(const char* key, double value, const char* why) {
  return fmt::format("{} = {:.6g}{}\n", key, value, why);
}

}  // namespace

Identified identify(const DeviceOnBench& device, const IdentifyLimits& limits) {
  Bench bench(device, limits);
  Identified found;
  bench.begin_record();
  if (bench.rest(0.25) && bench.travel_m() > kStill_m)
    bench.refuse("the handle moves by itself: let go of it, and balance its weight");
  const double loose_N = bench.refused().empty() ? breaks_loose_N(bench, limits.force_N) : 0;
  if (loose_N > 0) bench.rest(0.3);
  found.force_N = loose_N > 0 ? wide_enough_N(bench, 1.5 * loose_N, limits.force_N) : 0;
  if (found.force_N > 0) {
    bench.begin_record();
    if (swing(bench, found.force_N, kChirp_s, kChirpEnd_Hz)) bench.rest(0.1);
  }
  const DeviceRecord record = bench.record();
  if (bench.refused().empty()) {
    found.encoder_step_m = encoder_step_m(record.position_m);
    found.fit = fit_device(record);
    if (found.fit.residual_m > found.encoder_step_m + 0.02 * found.fit.travel_m)
      bench.refuse(
          fmt::format("the motion is not that of a free handle ({:.0f} um of {:.1f} mm are left unexplained): let go "
                      "of it, balance its weight, take cables away",
                      1e6 * found.fit.residual_m, 1e3 * found.fit.travel_m));
  }
  for (int i = 0; i < 5; ++i) {  // zero force, drives off
    DeviceSample sample;
    device.receive(sample);
    device.transmit({});
    device.wait();
  }
  found.refused = bench.refused();
  return found;
}

std::string profile_toml(const DeviceProfile& known, const Identified& measured) {
  constexpr const char* kMeasured = "  # measured by palpate doctor --identify";
  DeviceProfile p = known;
  p.mass_kg = measured.fit.mass_kg;
  p.damping_Ns_per_m = measured.fit.damping_Ns_per_m;
  p.friction_N = measured.fit.friction_N;
  p.encoder_step_m = measured.encoder_step_m;
  p.delay_s = measured.fit.delay_s;
  std::string text = "[device]\n" + fmt::format("name = \"{}\"\n", known.name);
#define PALPATE_LINE(member, key, value, lowest, highest, scale, meaning) \
  text += line(key, p.member / (scale), p.member != known.member ? kMeasured : "");
  PALPATE_PROFILE_KEYS(PALPATE_LINE)
#undef PALPATE_LINE
  return text;
}

Identified identify_simulated(const std::string& profile, const std::string& to) {
  std::string error;
  const auto known = read_device_profile(profile, error);
  if (!known) throw std::runtime_error(error);
  if (known->arm)
    throw std::runtime_error(profile + ": its drives report joints; identify measures devices that report a pose");
  PlantOptions plant;
  plant.mass_kg = known->mass_kg, plant.damping_N_s_per_m = known->damping_Ns_per_m;
  plant.friction_N = known->friction_N, plant.encoder_m = known->encoder_step_m;
  plant.force_max_N = known->force_max_N, plant.torque_max_Nm = known->torque_max_Nm;
  plant.hand_mass_kg = plant.hand_stiffness_N_per_m = plant.hand_damping_N_s_per_m = 0;  // nobody holds it
  plant.period_s = 1e-4, plant.substeps = 2;
  plant.delay_ticks = static_cast<int>(std::lround(known->delay_s / plant.period_s));
  VirtualClock clock;
  SimulatedDevice device(plant, HandPath(), clock);
  const DeviceOnBench bench{1e-3, [&](DeviceSample& sample) { device.receive(sample); },
                            [&](const DeviceCommand& command) { device.transmit(command); },
                            [&] { clock.advance(1'000'000); }};
  IdentifyLimits limits;
  limits.force_N = std::min(limits.force_N, 0.25 * known->force_max_N);
  const Identified found = identify(bench, limits);
  if (!found.refused.empty()) return found;
  std::ofstream file(to);
  file << profile_toml(*known, found);
  if (!file.flush()) throw std::runtime_error(to + ": cannot write");
  return found;
}

}  // namespace palpate
