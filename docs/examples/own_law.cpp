// A contact law of one's own: the tick finds where the tool is in the body and how deep, this program makes the force
// of it. Hunt and Crossley 1975, F = k d^(3/2) (1 + c d'), beside the scene's own law: the tool comes down 22 mm and
// withdraws.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "sim_host/palpate_host.h"

using namespace palpate;

constexpr double kStiffness = 4000, kDamping_s_per_m = 2;  // N/m^1.5

// Force on the tool in all. `before_m`: the deepest place of each region at the last tick.
Vec3 own_force_N(const State& state, double period_s, double (&before_m)[kMaxRegions]) {
  Vec3 sum_N;
  for (int i = 0; i < kMaxRegions; ++i) {
    const Region& region = state.region[i];
    const double depth_m = region.is_live() && region.lost_ticks == 0 ? std::max(region.depth_max_m, 0.0) : 0;
    const double speed = (depth_m - before_m[i]) / period_s;
    const double force_N = kStiffness * depth_m * std::sqrt(depth_m) * std::max(1 + kDamping_s_per_m * speed, 0.0);
    if (depth_m > 0) sum_N += force_N * region.normal_w;  // what is above is bounded and pushes, whatever the speed
    before_m[i] = depth_m;
  }
  return sum_N;
}

int main(int argc, char** argv) try {
  if (argc != 2) return std::puts("usage: own_law SCENE.toml"), 2;
  const SceneModel scene(argv[1]);
  const StatePtr state = make_state(scene.model());
  const ScratchPtr scratch = make_scratch(scene.model());
  Input input;
  input.drive = Drive::kTool;
  Output output;
  double before_m[kMaxRegions] = {};
  std::puts("height_mm,depth_mm,own_N,scene_N");
  for (int i = 0; i <= 1000; ++i) {
    input.pose_w.position_m = {-0.010, 0.090 - 0.000044 * std::min(i, 1000 - i), 0};
    tick(scene.model(), *state, *scratch, input, output);
    const Vec3 own_N = own_force_N(*state, scene.model().params.period_s, before_m);
    if (i % 5 == 0)
      std::printf("%.3f,%.4f,%.4f,%.4f\n", 1e3 * input.pose_w.position_m.y, 1e3 * output.penetration_m, own_N.y,
                  output.contact_w.force_N.y);
  }
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
