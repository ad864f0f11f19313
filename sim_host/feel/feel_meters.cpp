#include "sim_host/feel/feel_meters.h"

#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

// Swings count from twice what one step of the encoder makes through the coupling, and from 2 % of the largest force;
// of the torque from the same two.
SwingMeter force_swings(const ModelParams& params, double encoder_m) {
  return SwingMeter(std::max(2 * params.coupling_N_per_m * encoder_m, 0.02 * params.force_max_N));
}
SwingMeter torque_swings(const ModelParams& params, double encoder_rad) {
  return SwingMeter(std::max(2 * params.coupling_Nm_per_rad * encoder_rad, 0.02 * params.torque_max_Nm));
}

// Adds a tick's components; returns the ticks that swung so far, of the worst component.
int add_swings(Vec3 value, SwingMeter (&swing)[3]) {
  swing[0].add(value.x);
  swing[1].add(value.y);
  swing[2].add(value.z);
  return std::max({swing[0].turns(), swing[1].turns(), swing[2].turns()});
}

Vec3 mean_of(const std::vector<Vec3>& sample, std::size_t begin) {
  Vec3 sum;
  for (std::size_t i = begin; i < sample.size(); ++i) sum += sample[i];
  return (1.0 / static_cast<double>(std::max<std::size_t>(1, sample.size() - begin))) * sum;
}
// RMS about the mean along a direction, from sample `begin` on.
double spread(const std::vector<Vec3>& sample, std::size_t begin, Vec3 along) {
  const Vec3 mean = mean_of(sample, begin);
  double squares = 0;
  for (std::size_t i = begin; i < sample.size(); ++i)
    squares += dot(sample[i] - mean, along) * dot(sample[i] - mean, along);
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, sample.size() - begin)));
}

}  // namespace

void SwingMeter::add(double value) {
  const double step = value - last_;
  const bool turned = step * step_ < 0 && std::min(std::abs(step), std::abs(step_)) > least_;
  run_ = turned ? run_ + 1 : 0;
  turns_ += run_ > 2 ? 1 : run_ == 2 ? 2 : 0;
  longest_ = std::max(longest_, run_);
  step_ = step;
  last_ = value;
}

double band_rms(const std::vector<double>& sample, double period_s, double lowest_Hz, double highest_Hz) {
  const std::size_t n = sample.size();
  if (n < 16) return 0;
  double mean = 0, weight = 0;
  for (const double x : sample) mean += x / static_cast<double>(n);
  std::vector<double> windowed(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double hann = 0.5 - 0.5 * std::cos(2 * kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
    windowed[i] = hann * (sample[i] - mean);
    weight += hann * hann;
  }
  const double bin_Hz = 1 / (static_cast<double>(n) * period_s);
  double power = 0;
  for (std::size_t k = 1; 2 * k <= n; ++k) {
    const double f = static_cast<double>(k) * bin_Hz;
    if (f < lowest_Hz || f > highest_Hz) continue;
    double re = 0, im = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2 * kPi * static_cast<double>(k * i % n) / static_cast<double>(n);
      re += windowed[i] * std::cos(angle);
      im += windowed[i] * std::sin(angle);
    }
    power += (2 * k == n ? 1 : 2) * (re * re + im * im);
  }
  return std::sqrt(power / (static_cast<double>(n) * weight));
}

FeelMeters::FeelMeters(const ModelParams& params, const FeelSetup& setup)
    : params_(params),
      encoder_m_(setup.plant.encoder_m),
      friction_N_(setup.plant.friction_N),
      swing_{force_swings(params, encoder_m_), force_swings(params, encoder_m_), force_swings(params, encoder_m_)},
      torque_swing_{torque_swings(params, setup.encoder_rad), torque_swings(params, setup.encoder_rad),
                    torque_swings(params, setup.encoder_rad)} {
  figures_.force_limit_N = params.force_max_N;
  figures_.coupling_N_per_m = params.coupling_N_per_m;
  figures_.local = params.local_period_s > 0;
}

void FeelMeters::add(const FeelTick& tick) {
  const Output& out = tick.output;
  figures_.duration_s = tick.time_s + params_.period_s;
  figures_.force_max_N = std::max(figures_.force_max_N, norm(out.device_w.force_N));
  figures_.model_max_N = std::max(figures_.model_max_N, norm(out.contact_w.force_N));
  figures_.depth_max_m = std::max(figures_.depth_max_m, out.penetration_m);
  figures_.status |= out.status;
  figures_.fault |= out.fault;
  figures_.worst_mode = std::max(figures_.worst_mode, static_cast<int>(out.mode));
  if (out.contacts > 0)
    figures_.lag_m = std::max(figures_.lag_m, norm(tick.input.pose_w.position_m - out.tool_w.position_m));
  add_steps(tick);
  add_energy(tick);
  force_.push_back(out.device_w.force_N);
  handle_.push_back(tick.handle_w.position_m);
  contact_N_.push_back(tick.output.contact_w.force_N);
  tool_m_.push_back(tick.output.tool_w.position_m);
}

void FeelMeters::add_steps(const FeelTick& tick) {
  const ModelParams& p = params_;
  // A device that evaluates the local model is judged by what its motors do.
  const bool local = p.local_period_s > 0;
  figures_.alternations = add_swings(local ? tick.rendered_N : tick.output.device_w.force_N, swing_);
  for (const SwingMeter& swing : swing_) figures_.alternation_run = std::max(figures_.alternation_run, swing.longest());
  const Vec3 change =
      local ? tick.unmoved_N - last_.unmoved_N : tick.output.device_w.force_N - last_.output.device_w.force_N;
  const double step = force_.empty() ? 0 : norm(change) / p.force_max_N;
  if (step > figures_.step_share) figures_.step_share = step, figures_.step_at_s = tick.time_s;
  figures_.leash_share = std::max(figures_.leash_share, tick.stretch_m * p.coupling_N_per_m / p.force_max_N);
  if (p.torque_max_Nm > 0) add_torque(tick);  // a device without torque: its tool turns with the handle
  last_ = tick;
}

void FeelMeters::add_torque(const FeelTick& tick) {
  const ModelParams& p = params_;
  const Vec3 torque_Nm = tick.output.device_w.torque_Nm;
  figures_.torque_alternations = add_swings(torque_Nm, torque_swing_);
  figures_.torque_step_share =
      std::max(figures_.torque_step_share, norm(torque_Nm - last_.output.device_w.torque_Nm) / p.torque_max_Nm);
  figures_.leash_share = std::max(figures_.leash_share, tick.stretch_rad * p.coupling_Nm_per_rad / p.torque_max_Nm);
}

void FeelMeters::add_energy(const FeelTick& tick) {
  const bool touching = norm(tick.output.device_w.force_N) > 0 || norm(tick.rendered_N) > 0;
  if (touching && !touching_) {
    figures_.contacts += 1;
    port_begin_J_ = tick.energy.motor_J - tick.fingers_J;
    hand_begin_J_ = tick.energy.to_hand_J() - tick.fingers_J;
    quantum_J_ = 0;
  }
  if (touching && !handle_.empty()) {
    const Vec3 way = tick.handle_w.position_m - handle_.back();
    const double along_axes_m = std::abs(way.x) + std::abs(way.y) + std::abs(way.z);
    quantum_J_ += params_.coupling_N_per_m * encoder_m_ * along_axes_m - friction_N_ * norm(way);
    figures_.quantum_J = std::max(figures_.quantum_J, quantum_J_);
  }
  figures_.fingers_J = std::max(figures_.fingers_J, tick.fingers_J);
  // The command of the tick before acts until now, so the tick after the last one with force still belongs to it.
  if (touching || touching_) {
    figures_.port_J = std::max(figures_.port_J, tick.energy.motor_J - tick.fingers_J - port_begin_J_);
    figures_.hand_J = std::max(figures_.hand_J, tick.energy.to_hand_J() - tick.fingers_J - hand_begin_J_);
  }
  touching_ = touching;
}

double FeelMeters::felt_stiffness() const {
  std::size_t most = 0;
  for (std::size_t i = 0; i < force_.size(); ++i)
    if (norm(force_[i]) > norm(force_[most])) most = i;
  if (force_.empty() || !(norm(force_[most]) > 0)) return 0;
  std::size_t half = 0;
  for (std::size_t i = 0; i < most; ++i)
    if (norm(force_[i]) < 0.5 * norm(force_[most])) half = i;
  const Vec3 rise = force_[most] - force_[half];
  const double way = -dot(handle_[most] - handle_[half], unit_or(rise, {}));
  return way > 1e-6 ? norm(rise) / way : 0;
}

std::size_t FeelMeters::last_second() const {
  return force_.size() - std::min(force_.size(), static_cast<std::size_t>(std::lround(1 / params_.period_s)));
}

double FeelMeters::noise() const {
  double power = 0;
  for (const auto component : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    std::vector<double> last;
    for (std::size_t i = last_second(); i < force_.size(); ++i) last.push_back(force_[i].*component);
    const double rms = band_rms(last, params_.period_s, 50, 500);
    power += rms * rms;
  }
  return std::sqrt(power);
}

double FeelMeters::object_stiffness() const {
  const Vec3 pressed = unit_or(mean_of(contact_N_, last_second()), {});
  const double moved_m = spread(tool_m_, last_second(), pressed),
               changed_N = spread(contact_N_, last_second(), pressed);
  return moved_m > 1e-9 ? changed_N / moved_m : 0;
}

FeelFigures FeelMeters::figures() const {
  FeelFigures figures = figures_;
  figures.felt_N_per_m = felt_stiffness();
  figures.noise_N = noise();
  figures.object_N_per_m = object_stiffness();
  return figures;
}

}  // namespace palpate
