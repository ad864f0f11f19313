#include "sim_host/bake/default_path.h"

#include <algorithm>

namespace palpate {

namespace {

constexpr double kGap_m = 0.02;
constexpr double kDeepest = 0.1;  // of the body's height, at most half the law's depth: every law holds there
constexpr double kSlide = 0.1;    // of the body's length along x

// Of the tool, turned as it is described, below its origin.
double lowest_of_tool_m(const Model& model) {
  double lowest = kHuge;
  for (const ToolPoint& point : model.tool_point) lowest = std::min(lowest, point.position_tool_m.y - point.margin_m);
  return lowest;
}

}  // namespace

bool add_default_path(SceneDesc& scene, const Model& model) {
  if (!scene.path.point.empty() || scene.articulation != Articulation::kRigid || model.vertex_m.empty()) return false;
  Vec3 lower = model.vertex_m[0], upper = lower, top = lower;
  for (const Vec3& p : model.vertex_m) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    if (p.y > top.y) top = p;
  }
  const Vec3 touching = top - Vec3{0, lowest_of_tool_m(model), 0}, above = touching + Vec3{0, kGap_m, 0};
  const double depth_m = std::min(kDeepest * (upper.y - lower.y), 0.5 * scene.contact.max_depth_m);
  const Vec3 pressed = touching - Vec3{0, depth_m, 0}, slid = pressed + Vec3{kSlide * (upper.x - lower.x), 0, 0};
  const auto add = [&](double time_s, Vec3 position_m) {
    PathPoint point;
    point.time_s = time_s;
    point.position_m = position_m;
    scene.path.point.push_back(point);
  };
  add(0, above);
  add(1, touching);
  add(3, pressed);
  add(4, pressed);
  add(8, slid);
  add(9, slid + Vec3{0, kGap_m, 0});
  add(10, above);
  return true;
}

}  // namespace palpate
