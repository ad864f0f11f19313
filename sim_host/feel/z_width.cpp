#include "sim_host/feel/z_width.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rt_core/device_profile.h"
#include "sim_host/view/line_plot.h"

namespace palpate {

namespace {

FeelSetup setup_of(const BareDevice& device, double seconds) {
  FeelSetup setup;
  setup.period_s = device.period_s;
  setup.delay_s = device.delay_s;
  PlantOptions& plant = setup.plant;
  plant.mass_kg = device.mass_kg;
  plant.damping_N_s_per_m = device.damping_N_s_per_m;
  plant.friction_N = device.friction_N;
  plant.encoder_m = device.encoder_m;
  plant.local_Hz = device.local_Hz;
  plant.local_N_per_m = 1e9;
  plant.force_max_N = 1e9;
  plant.hand_mass_kg = plant.hand_stiffness_N_per_m = plant.hand_damping_N_s_per_m = 0;
  setup.path = HandPath({{0, {{device.start_m, 0, 0}, {}}}, {seconds, {{device.start_m, 0, 0}, {}}}});
  return setup;
}

// Lets the mass go off the middle of a two-sided spring.
void let_go(const BareDevice& device, double stiffness_N_per_m, double seconds, const FeelListener& listen) {
  run_feel_loop(
      setup_of(device, seconds),
      [&](const Input& input, Output& output) {
        output.device_w.force_N = -stiffness_N_per_m * input.pose_w.position_m;
        output.handle_w_m = input.pose_w.position_m;
        output.felt_along_N_per_m = {stiffness_N_per_m, stiffness_N_per_m, stiffness_N_per_m};
      },
      listen);
}

}  // namespace

bool settles(const BareDevice& device, double stiffness_N_per_m, double seconds) {
  double early = 0, late = 0;
  let_go(device, stiffness_N_per_m, seconds, [&](const FeelTick& now) {
    const double way = std::abs(now.handle_w.position_m.x);
    if (now.time_s >= 0.25 * seconds && now.time_s < 0.5 * seconds) early = std::max(early, way);
    if (now.time_s >= 0.75 * seconds) late = std::max(late, way);
  });
  return late < early && late < 2 * device.start_m;
}

bool rests(const BareDevice& device, double stiffness_N_per_m, double seconds) {
  double lowest = 1e9, highest = -1e9;
  let_go(device, stiffness_N_per_m, seconds, [&](const FeelTick& now) {
    if (now.time_s < 0.75 * seconds) return;
    lowest = std::min(lowest, now.handle_w.position_m.x);
    highest = std::max(highest, now.handle_w.position_m.x);
  });
  return highest - lowest < 0.1 * device.encoder_m;
}

double measured_limit_N_per_m(const BareDevice& device) {
  double low = 0.01 * rule_limit_N_per_m(device), high = 20 * rule_limit_N_per_m(device);
  while (high > 1.002 * low) {
    const double middle = std::sqrt(low * high);
    (settles(device, middle) ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

double rule_limit_N_per_m(const BareDevice& device) {
  return admissible_stiffness(device.damping_N_s_per_m, device.friction_N, 0, device.period_s, device.delay_s,
                              device.local_Hz)
      .value;
}

Drawing z_width_plot() {
  std::vector<PlotCurve> curves;
  for (const double delay_s : {0.0, 5e-4, 1e-3, 3e-3}) {
    PlotCurve measured{fmt::format("{:g} ms measured", 1e3 * delay_s), {}, {}};
    PlotCurve rule{fmt::format("{:g} ms, 2b/(T+2 tau)", 1e3 * delay_s), {}, {}};
    for (const double damping : {0.05, 0.25, 0.5, 1.0, 1.5, 2.0, 2.5}) {
      const BareDevice device{0.2, damping, delay_s};
      measured.x.push_back(damping);
      measured.y.push_back(1e-3 * measured_limit_N_per_m(device));
      rule.x.push_back(damping);
      rule.y.push_back(1e-3 * rule_limit_N_per_m(device));
    }
    curves.push_back(std::move(measured));
    curves.push_back(std::move(rule));
  }
  for (const double delay_s : {0.0, 3e-3}) {
    PlotCurve local{fmt::format("{:g} ms, local model at 10 kHz", 1e3 * delay_s), {}, {}};
    for (const double damping : {0.05, 0.25, 0.5, 1.0, 1.5, 2.0, 2.5}) {
      BareDevice device{0.2, damping, delay_s};
      device.local_Hz = 1e4;
      local.x.push_back(damping);
      local.y.push_back(1e-3 * measured_limit_N_per_m(device));
    }
    curves.push_back(std::move(local));
  }
  return line_plot(curves,
                   {"Z-width of a bare device of 0.2 kg at 1 kHz", "damping of the device (N s/m)",
                    "stiffest spring that settles (N/mm)"},
                   true);
}

}  // namespace palpate
