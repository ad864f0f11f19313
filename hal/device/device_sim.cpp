#include "hal/device/device_sim.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rt_core/device_profile.h"

namespace palpate {
namespace {

double quantised(double value, double quantum) noexcept {
  return quantum > 0 ? quantum * std::floor(value / quantum + 0.5) : value;
}

// v cut to length `limit`; a vector that is not finite is no vector.
Vec3 limited(Vec3 v, double limit, bool& cut) noexcept {
  if (!is_finite(v)) {
    cut = true;
    return {};
  }
  const double length = norm(v);
  if (!(length > limit)) return v;
  cut = true;
  return (limit / length) * v;
}

// One of the handle's two motions, straight or turning: `motor` and a hand that pulls by `stiffness * error` and
// `damping * (hand_velocity - v)` move a mass with damping and Coulomb friction.
struct Motion {
  double mass, device_damping, friction;
  double hand_stiffness, hand_damping;
  Vec3 motor, error, hand_velocity;
};

// Implicit midpoint step of M dv/dt = motor + K (error - x) + B_hand (v_hand - v) - b v - friction:
//   (2 M/dt + b + B + K dt/2) v_mid = 2 M/dt v + K error + B v_hand + motor - friction direction,
// where Coulomb friction is the projection of the right-hand side onto the ball of its radius: sticking is exact.
// Moves `velocity` on; returns its mean, which moves the position; adds the work done in dt.
Vec3 midpoint_step(const Motion& m, double dt_s, Vec3& velocity, PlantEnergy& energy) noexcept {
  const double inertia = 2 * m.mass / dt_s;
  const Vec3 push = m.motor + m.hand_stiffness * m.error + m.hand_damping * m.hand_velocity;
  const Vec3 effort = inertia * velocity + push;
  const double size = norm(effort);
  if (!(size > m.friction)) {
    energy.lost_J += 0.5 * m.mass * squared_norm(velocity);  // the rest of it
    velocity = {};
    return {};
  }
  const double damping = m.device_damping + m.hand_damping;
  const double resisted = inertia + damping + 0.5 * m.hand_stiffness * dt_s;
  const Vec3 mean = ((1 - m.friction / size) / resisted) * effort;
  velocity = 2.0 * mean - velocity;
  const Vec3 hand = m.hand_stiffness * (m.error - 0.5 * dt_s * mean) + m.hand_damping * (m.hand_velocity - mean);
  energy.motor_J += dt_s * dot(m.motor, mean);
  energy.hand_J += dt_s * dot(hand, mean);
  energy.lost_J += dt_s * (m.device_damping * squared_norm(mean) + m.friction * norm(mean));
  return mean;
}

PlantOptions checked(PlantOptions o) {
  o.delay_ticks = std::clamp(o.delay_ticks, 0, kMaxDelayTicks);
  o.substeps = std::clamp(o.substeps, 1, 1000);
  if (o.local_Hz > 0 && !(o.local_N_per_m > 0))
    o.local_N_per_m =
        admissible_stiffness(o.damping_N_s_per_m, o.friction_N, o.encoder_m, o.period_s, 0, o.local_Hz).value;
  return o;
}

}  // namespace

DevicePlant::DevicePlant(const PlantOptions& options, HandPath path)
    : options_(checked(options)),
      path_(std::move(path)),
      random_(options.noise_seed),
      handle_({options.encoder_m, options.local_Hz > 0 ? 1 / options.local_Hz : options.period_s, options.mass_kg,
               options.friction_N},
              path_.at(0).pose.position_m) {
  pose_ = path_.at(0).pose;
  last_measured_m_ = observed_m_ = last_exact_m_ = pose_.position_m;
}

void DevicePlant::drive(const DeviceCommand& command) noexcept {
  delay_[ticks_ % kDelaySlots] = command;
  const auto delay = static_cast<std::uint64_t>(options_.delay_ticks);
  const DeviceCommand due = ticks_ >= delay ? delay_[(ticks_ - delay) % kDelaySlots] : DeviceCommand{};
  saturated_ = false;
  const bool is_new = due.number != due_.number;
  if (is_new) age_s_ = 0;
  due_ = due;
  due_.local = is_finite(due.force_N) ? bounded_model(due.local, options_.local_N_per_m) : LocalModel{};
  if (!is_finite(due.force_N)) due_.force_N = {};
  const Vec3 before_N = motor_.force_N;
  motor_ = {};
  const bool enabled = (due.flags & CommandFlag::kEnable) != 0;
  if (!enabled) due_.force_N = {}, due_.local = {};
  if (is_new) handle_.obey(due_.force_N, due_.local);
  if (!enabled) return;
  motor_.force_N = limited(due.force_N, options_.force_max_N, saturated_);
  motor_.torque_Nm = limited(due.torque_Nm, options_.torque_max_Nm, saturated_);
  if (options_.local_Hz > 0) motor_.force_N = before_N;  // evaluated within this period
}

// The device's own fast loop: smooths its encoder, and renders what a command says there, with its model or without.
void DevicePlant::evaluate_local(double elapsed_s) noexcept {
  if (!(options_.local_Hz > 0)) return;
  const double period_s = 1 / options_.local_Hz;
  local_due_s_ -= elapsed_s;
  age_s_ += elapsed_s;
  if (local_due_s_ > 1e-9) return;
  local_due_s_ += period_s;
  const Vec3 before_m = observed_m_, moved_m = pose_.position_m - last_exact_m_;
  last_exact_m_ = pose_.position_m;
  observed_m_ = handle_.next(encoder_m());
  if ((due_.flags & CommandFlag::kEnable) == 0) return;
  const bool stale = age_s_ > due_.local.valid_s;  // or none
  if (!stale) evaluated_m_ = observed_m_;
  const LocalLoop loop{period_s, options_.force_max_N, 1e3 * options_.local_slope_share_per_ms * options_.force_max_N,
                       options_.encoder_m};
  const LocalWay way = stale ? LocalWay{evaluated_m_, evaluated_m_} : LocalWay{before_m, observed_m_};
  const Vec3 wanted_N = local_force_N(due_.force_N, due_.local, way.to_m), last_N = motor_.force_N;
  saturated_ = saturated_ || squared_norm(wanted_N) > options_.force_max_N * options_.force_max_N;
  motor_.force_N = next_force_N(loop, last_N, due_.force_N, due_.local, way);
  const LocalWay exact = stale ? way : LocalWay{before_m, before_m + moved_m};
  unmoved_N_ += motor_.force_N - last_N - moved_force_N(loop, due_.force_N, due_.local, exact);
}

HandTarget DevicePlant::aim_at(double time_s) const noexcept {
  if (!pulled_) return path_.at(time_s);
  const double since_s = time_s - hand_s_;
  HandTarget hand = hand_;
  hand.pose.position_m += since_s * hand.velocity_m_per_s;
  hand.pose.orientation = normalised(rotation_by(since_s * hand.spin_rad_per_s) * hand.pose.orientation);
  return hand;
}

void DevicePlant::pull(const Pose& target, bool trigger) noexcept {
  if (!pulled_) {
    hand_ = path_.at(time_s());
    hand_s_ = time_s();
    pulled_ = true;
  }
  wish_ = {target.position_m, normalised(target.orientation)};
  hand_.trigger = trigger;
}

// One period of a critically damped spring from the hand to where it is told to go: a mouse moves in steps of its own
// 60 to 125 Hz, which a hand does not feel. Faster than 1 m/s and 6 rad/s nobody explores with care (assumption).
void DevicePlant::follow() noexcept {
  if (!pulled_) return;
  constexpr double kRate_per_s = 50, kFastest_m_per_s = 1, kFastest_rad_per_s = 6;
  const double dt_s = time_s() - hand_s_;
  if (!(dt_s > 0)) return;
  const HandTarget here = aim_at(time_s());
  bool ignored = false;
  // Implicit in the velocity, hence stable at any period: v' = (v + w^2 dt x) / (1 + 2 w dt + w^2 dt^2).
  const double w = kRate_per_s, soft = 1 / (1 + 2 * w * dt_s + w * w * dt_s * dt_s);
  const Vec3 way = wish_.position_m - here.pose.position_m;
  const Vec3 turn = rotation_vector(wish_.orientation * conjugate(here.pose.orientation));
  hand_.pose = here.pose;
  hand_.velocity_m_per_s = limited(soft * (here.velocity_m_per_s + w * w * dt_s * way), kFastest_m_per_s, ignored);
  hand_.spin_rad_per_s = limited(soft * (here.spin_rad_per_s + w * w * dt_s * turn), kFastest_rad_per_s, ignored);
  hand_s_ = time_s();
}

// The hand's aim with its tremor: a circle in two axes and a slower line in the third, so no direction is spared.
HandTarget DevicePlant::hand_at(double time_s) const noexcept {
  HandTarget hand = aim_at(time_s);
  if (!(options_.tremor_m > 0) && !(options_.tremor_rad > 0)) return hand;
  const double w = 2 * kPi * options_.tremor_Hz;
  const double s = std::sin(w * time_s), c = std::cos(w * time_s), u = 0.87 * w;
  const Vec3 shake{c, s, std::sin(u * time_s)}, rate{-w * s, w * c, u * std::cos(u * time_s)};
  hand.pose.position_m += options_.tremor_m * shake;
  hand.velocity_m_per_s += options_.tremor_m * rate;
  hand.pose.orientation = rotation_by(options_.tremor_rad * shake) * hand.pose.orientation;
  hand.spin_rad_per_s += options_.tremor_rad * rate;
  return hand;
}

void DevicePlant::integrate(double time_s, double dt_s) noexcept {
  const PlantOptions& o = options_;
  const HandTarget hand = hand_at(time_s + 0.5 * dt_s);
  const Motion straight{o.mass_kg + o.hand_mass_kg,
                        o.damping_N_s_per_m,
                        o.friction_N,
                        o.hand_stiffness_N_per_m,
                        o.hand_damping_N_s_per_m,
                        motor_.force_N,
                        hand.pose.position_m - pose_.position_m,
                        hand.velocity_m_per_s};
  pose_.position_m += dt_s * midpoint_step(straight, dt_s, velocity_, energy_);
  const Motion turning{o.inertia_kg_m2,
                       o.damping_Nm_s_per_rad,
                       o.friction_Nm,
                       o.hand_stiffness_Nm_per_rad,
                       o.hand_damping_Nm_s_per_rad,
                       motor_.torque_Nm,
                       rotation_vector(hand.pose.orientation * conjugate(pose_.orientation)),
                       hand.spin_rad_per_s};
  const Vec3 spin = midpoint_step(turning, dt_s, spin_, energy_);
  pose_.orientation = normalised(rotation_by(dt_s * spin) * pose_.orientation);
}

double DevicePlant::kinetic_J() const noexcept {
  return 0.5 * ((options_.mass_kg + options_.hand_mass_kg) * squared_norm(velocity_) +
                options_.inertia_kg_m2 * squared_norm(spin_));
}

void DevicePlant::step(const DeviceCommand& command) noexcept {
  drive(command);
  follow();
  const double dt_s = options_.period_s / options_.substeps;
  const double start_s = time_s();
  for (int i = 0; i < options_.substeps; ++i) {
    evaluate_local(dt_s);
    integrate(start_s + i * dt_s, dt_s);
  }
  ticks_ += 1;
}

// splitmix64 (Steele, Lea & Flood 2014): uniform in [-1, 1).
double DevicePlant::noise() noexcept {
  std::uint64_t z = random_ += 0x9E3779B97F4A7C15ull;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

Vec3 DevicePlant::measured_m() noexcept { return options_.local_Hz > 0 ? observed_m_ : encoder_m(); }

Vec3 DevicePlant::encoder_m() noexcept {
  if (frozen_) return last_measured_m_;
  Vec3 p = pose_.position_m + encoder_shift_m_;
  if (options_.noise_m > 0) {
    p.x += options_.noise_m * noise();
    p.y += options_.noise_m * noise();
    p.z += options_.noise_m * noise();
  }
  const double q = options_.encoder_m;
  last_measured_m_ = {quantised(p.x, q), quantised(p.y, q), quantised(p.z, q)};
  return last_measured_m_;
}

SimulatedDevice::SimulatedDevice(const PlantOptions& options, HandPath path, const VirtualClock& clock)
    : plant_(options, std::move(path)),
      clock_(clock),
      start_ns_(clock.now_ns()),
      period_ns_(static_cast<std::int64_t>(std::llround(1e9 * options.period_s))) {}

void SimulatedDevice::receive(DeviceSample& sample) noexcept {
  constexpr std::uint64_t kMostPeriods = 100'000;  // bound of one catching up
  const auto due = static_cast<std::uint64_t>((clock_.now_ns() - start_ns_) / period_ns_);
  const std::uint64_t before = plant_.ticks();
  while (plant_.ticks() < due && plant_.ticks() - before < kMostPeriods) plant_.step(command_);
  const auto elapsed = static_cast<std::uint32_t>(plant_.ticks() - before);
  sample_.fresh = elapsed > 0 || first_;
  sample_.received = sample_.fresh ? 1 : 0;
  if (sample_.fresh) {
    sample_.position_m = plant_.measured_m();
    sample_.orientation = plant_.pose().orientation;
    sample_.sequence = static_cast<std::uint32_t>(plant_.ticks()) & 0xFFFFu;
    sample_.device_time_us = static_cast<std::uint32_t>(plant_.ticks() * static_cast<std::uint64_t>(period_ns_) / 1000);
    sample_.flags = DeviceFlag::kCalibrated;
    if ((command_.flags & CommandFlag::kEnable) != 0) sample_.flags |= DeviceFlag::kEnabled;
    if (plant_.saturated()) sample_.flags |= DeviceFlag::kSaturated;
    if (plant_.options().local_Hz > 0) sample_.flags |= DeviceFlag::kLocalModel;
  }
  first_ = false;
  sample = sample_;
}

bool SimulatedDevice::transmit(const DeviceCommand& command) noexcept {
  const std::uint32_t number = command_.number + 1;
  command_ = command;
  command_.number = number;
  return true;
}

}  // namespace palpate
