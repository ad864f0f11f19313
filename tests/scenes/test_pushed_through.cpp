// A tool pushed through a body at a hand's speed never lies inside it without being in contact: along straight lines
// through the body, from all sides, behind the coupling of the scene's device. What lies inside is found again at every
// tick by other means than the tick's: cold searches over the whole surface, or the pieces' gaps at the nodes of a
// finite-element body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>

#include "rt_core/contact/contact.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/tick.h"
#include "rt_core/tool/articulate.h"
#include "rt_core/tool/shapes.h"
#include "sim_host/tick_memory.h"
#include "tests/support/image_file.h"

namespace palpate::test {
namespace {

// Depth of the tool in the body at rest, > 0 inside.
double depth_at_rest_m(const Model& model, const State& state) {
  double depth_m = -1;
  if (method_of(model) == Method::kNodes) {
    for (const ToolPiece& piece : model.piece) {
      const Pose piece_w = state.tool_w * piece.pose_tool;
      for (const Vec3 node : model.vertex_m)
        depth_m = std::max(depth_m, -piece_gap(piece, inverse_transform(piece_w, node)).gap_m);
    }
    return depth_m;
  }
  for (const ToolPoint& point : model.tool_point) {
    const Pose carrier = carrier_w(model, state, point.piece);
    const SurfacePoint s = closest_surface_point(model, transform(carrier, point.position_tool_m), kHuge, -1);
    if (s.found) depth_m = std::max(depth_m, point.margin_m - s.signed_distance_m);
  }
  return depth_m;
}

struct Found {
  long inside = 0, contact = 0, unfelt = 0;
  double deepest_unfelt_m = 0;
};

struct Box {
  Vec3 middle, half;
};
Box box_of(const Model& model) {
  Vec3 low = model.vertex_m[0], high = low;
  for (const Vec3 v : model.vertex_m) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  return {0.5 * (low + high), 0.5 * (high - low)};
}

// Turns the tool's -y, along which rods point, into `along`.
Quat pointing(Vec3 along) {
  const Vec3 axis = cross({0, -1, 0}, along);
  const double w = 1 - along.y;
  return w > 1e-9 ? normalised({w, axis.x, axis.y, axis.z}) : Quat{0, 1, 0, 0};
}

Found push_through(const Model& model, double speed_m_per_s, int lines) {
  const Box box = box_of(model);
  const double size_m = 2 * norm(box.half), step_m = speed_m_per_s * model.params.period_s;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> across(-1, 1);
  std::normal_distribution<double> normal;
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  Found found;
  for (int line = 0; line < lines; ++line) {
    const Vec3 any{normal(random), normal(random), normal(random)};
    const Vec3 along = line % 3 == 0 ? Vec3{0, -1, 0} : unit_or(any, {0, -1, 0});
    const Vec3 target =
        box.middle + Vec3{across(random) * box.half.x, across(random) * box.half.y, across(random) * box.half.z};
    Input input;
    input.pose_w = {target - 1.2 * size_m * along, pointing(along)};
    Output output;
    reset(*state);
    const int ticks = static_cast<int>(2.4 * size_m / step_m);
    for (int k = -200; k < ticks; ++k) {
      input.commands = k == -198 ? Command::kArm : 0;
      if (k > 0) input.pose_w.position_m += step_m * along;
      tick(model, *state, *scratch, input, output);
      if (output.fault != 0) break;  // pushed by more than the device holds: nothing is rendered any more
      const double depth_m = depth_at_rest_m(model, *state);
      const bool felt = output.contacts > 0;
      found.contact += felt ? 1 : 0;
      found.inside += depth_m > 0 ? 1 : 0;
      // The smooth surface, which tips touch, may lie so far below the facets.
      if (felt || !(depth_m > model.params.smooth_slack_m + 1e-6)) continue;
      found.unfelt += 1;
      found.deepest_unfelt_m = std::max(found.deepest_unfelt_m, depth_m);
    }
  }
  return found;
}

class PushedThrough : public testing::TestWithParam<const char*> {};
TEST_P(PushedThrough, IsNeverInsideWithoutContact) {
  const ImageFile image(std::string(PALPATE_IMAGE_DIR) + "/" + GetParam() + ".pal");
  const Model& model = image.model();
  // 1.3 m/s: about what a handle may reach from rest within a tick (device.acceleration_max_m_per_s2), 1.3 mm a tick.
  for (const double speed : {0.5, 1.3}) {
    const Found found = push_through(model, speed, speed < 1 ? 18 : 36);
    std::printf("%s at %.1f m/s: inside in %ld ticks, in contact in %ld, inside without contact in %ld (%.4f mm)\n",
                GetParam(), speed, found.inside, found.contact, found.unfelt, 1e3 * found.deepest_unfelt_m);
    EXPECT_GT(found.contact, 500);
    // A body in parts is bent by what has just let it go, and asked as it is at rest; a foot that comes round to
    // another part may be a tick late; one that comes end on over an edge is lost in every other tick. Measured
    // 2026-11-26: snap_in 1 of 1,093 ticks and 31 of 852.
    const bool in_parts = model.tool_point.size() > 0 && model.tool_point[0].begins_at > 0;
    EXPECT_LE(found.unfelt, in_parts ? found.inside / 25 : 0);
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, PushedThrough,
                         testing::Values("half_shell", "half_shell_paper", "ring", "ring_paper", "hollow_cylinder",
                                         "snap_in", "snap_in_paper"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace palpate::test
