#include "sim_host/run/tick_fit.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>
#include <thread>
#include <vector>

#include "hal/loop/clock.h"
#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"

namespace palpate {

namespace {

constexpr int kStarts = 12, kTicks = 30, kRepetitions = 5;
// Before a scene is refused. Something else on the processor that keeps step with the repetitions hits the same tick in
// all of them: in the laboratory's virtual time, where all takes the same each time, a device did five times in a row
// (1,085 us for a tick of 96, 2026-11-23). Pauses of changing length break the step.
constexpr int kMostRepetitions = 15;
constexpr std::int64_t kPause_ns = 370'000;

class Prober {
 public:
  explicit Prober(const Model& model) : model_(model) {}

  // Plays all starts; keeps each tick's time where it is less than what `fastest_ns` has.
  void play(std::vector<double>& fastest_ns) {
    const MonotonicClock clock;
    std::size_t at = 0;
    for (int start = 0; start < kStarts; ++start) {
      random_.seed(static_cast<std::uint64_t>(start));
      reset(*state_);
      Input input;
      input.drive = Drive::kTool;
      input.pose_w = touching_anywhere();
      for (float& closing : input.joints.closing) closing = static_cast<float>(uniform(0, 1));
      for (int i = 0; i < kTicks; ++i, ++at) {
        const std::int64_t before_ns = clock.now_ns();
        tick(model_, *state_, *scratch_, input, output_);
        const auto taken_ns = static_cast<double>(clock.now_ns() - before_ns);
        fastest_ns[at] = std::min(fastest_ns[at], taken_ns);
        input.pose_w.position_m += vector(2e-3);
        input.pose_w.orientation = normalised(small_rotation(vector(0.03)) * input.pose_w.orientation);
      }
    }
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
  }
  Vec3 vector(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size);
    return {x, y, uniform(-size, size)};
  }
  // Some tool point at or below some place of the surface, the tool turned anyhow.
  Pose touching_anywhere() {
    const std::size_t v = random_() % model_.vertex_m.size();
    const ToolPoint& point = model_.tool_point[random_() % model_.tool_point.size()];
    const double deep_m = uniform(-1e-3, std::min(model_.params.max_depth_m, 0.1 * model_.params.surface_size_m));
    Pose pose{{}, small_rotation(vector(2))};
    if (!model_.grasp_w.empty()) pose.orientation = model_.grasp_w[0].orientation;
    const Vec3 target = model_.vertex_m[v] + (point.margin_m - deep_m) * model_.vertex_normal[v];
    pose.position_m = target - rotate(pose.orientation, point.position_tool_m);
    return pose;
  }

  const Model& model_;
  StatePtr state_ = make_state(model_);
  ScratchPtr scratch_ = make_scratch(model_);
  Output output_;
  std::mt19937_64 random_;
};

}  // namespace

double measure_slowest_tick_ns(const Model& model) {
  std::vector<double> fastest_ns(std::size_t{kStarts} * kTicks, kHuge);
  Prober prober(model);
  double slowest_ns = kHuge;
  for (int i = 0; i < kRepetitions || (i < kMostRepetitions && !fits_period(slowest_ns, model.params.period_s)); ++i) {
    if (i >= kRepetitions) std::this_thread::sleep_for(std::chrono::nanoseconds(i * kPause_ns));
    prober.play(fastest_ns);
    slowest_ns = *std::ranges::max_element(fastest_ns);
  }
  return slowest_ns;
}

std::string tick_fit_text(const TickFit& fit) {
  char text[240];
  std::snprintf(
      text, sizeof text,
      "worst tick: at most %.0f instructions; the slowest of %d that look for it took %.0f us here, of %.0f us in "
      "a period%s",
      fit.instructions, kStarts * kTicks, 1e-3 * fit.slowest_ns, 1e6 * fit.period_s,
      fit.fits() ? "" : "; it may take 80 %");
  return text;
}

}  // namespace palpate
