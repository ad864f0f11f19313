#include "sim_host/feel/feel_loop.h"

#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

PlantOptions stepped(const FeelSetup& setup) {
  PlantOptions plant = setup.plant;
  plant.period_s = kFeelSubstep_s;
  plant.substeps = 1;
  plant.delay_ticks = static_cast<int>(std::lround(setup.delay_s / kFeelSubstep_s));
  return plant;
}

// An orientation told in steps about each axis.
class AngleEncoder {
 public:
  AngleEncoder(Quat zero, double step_rad) : zero_(zero), step_rad_(step_rad) {}
  Quat told(Quat orientation) const {
    if (!(step_rad_ > 0)) return orientation;
    const auto whole = [&](double x) { return step_rad_ * std::floor(x / step_rad_ + 0.5); };
    const Vec3 turn = rotation_vector(orientation * conjugate(zero_));
    return normalised(rotation_by({whole(turn.x), whole(turn.y), whole(turn.z)}) * zero_);
  }

 private:
  Quat zero_;
  double step_rad_;
};

// The samples as they reach the controller.
class Samples {
 public:
  Samples(const FeelSetup& setup, const DevicePlant& plant)
      : setup_(setup), angle_(plant.pose().orientation, setup.encoder_rad) {}

  void next(double time_s, DevicePlant& plant, Input& input) {
    for (; next_ < setup_.event.size() && setup_.event[next_].time_s <= time_s + 1e-9; ++next_) {
      lost_ += setup_.event[next_].lose;
      plant.shift_encoder(setup_.event[next_].shift_m);
    }
    const bool due = setup_.sample_period_s <= setup_.period_s || time_s + 1e-9 >= due_s_;
    if (due) due_s_ += setup_.sample_period_s;
    const Vec3 position_m = plant.measured_m();
    if (due && lost_ == 0) {
      input.pose_w = {position_m, angle_.told(plant.pose().orientation)};
      input.stale_ticks = 0;
    } else {
      input.stale_ticks += 1;
    }
    lost_ -= lost_ > 0 ? 1 : 0;
  }

 private:
  const FeelSetup& setup_;
  AngleEncoder angle_;
  std::size_t next_ = 0;
  std::uint32_t lost_ = 0;
  double due_s_ = 0;
};

}  // namespace

void run_feel_loop(const FeelSetup& setup, const FeelController& controller, const FeelListener& listen) {
  DevicePlant plant(stepped(setup), setup.path);
  Samples samples(setup, plant);
  const int substeps = std::max(1, static_cast<int>(std::lround(setup.period_s / kFeelSubstep_s)));
  const auto ticks = static_cast<std::int64_t>(std::ceil(setup.path.end_s() / setup.period_s));
  FeelTick now;
  DeviceCommand command;
  bool armed = false;
  for (std::int64_t n = 0; n < ticks; ++n) {
    now.time_s = static_cast<double>(n) * setup.period_s;
    now.handle_w = plant.pose();
    now.energy = plant.energy();
    now.kinetic_J = plant.kinetic_J();
    if (setup.plant.local_Hz > 0) now.rendered_N = plant.motor().force_N;
    now.unmoved_N = plant.unmoved_N();
    samples.next(now.time_s, plant, now.input);
    if (setup.echoes && now.input.stale_ticks == 0)
      now.input.command_lag = static_cast<std::uint32_t>(n) - plant.obeyed();
    // An operator arms again until it is heard: the edge counts only in a tick with a fresh sample.
    armed = armed || (n > 0 && now.input.stale_ticks == 0);
    now.input.commands = armed ? Command::kArm : 0;
    if (setup.joints) now.input.joints = setup.joints(now.time_s);
    controller(now.input, now.output);
    listen(now);
    const DeviceCommand newest =
        to_command({}, now.output, CommandFlag::kEnable, setup.plant.local_Hz > 0 ? kLocalValid_s : 0);
    if (n % 16 >= setup.lost_of_16) {
      command = newest;
      command.number = static_cast<std::uint32_t>(n + 1);
    }
    for (int i = 0; i < substeps; ++i) plant.step(command);
  }
}

}  // namespace palpate
