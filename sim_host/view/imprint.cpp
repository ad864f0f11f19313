#include "sim_host/view/imprint.h"

#include <algorithm>
#include <cmath>

#include "config/hand/hand_model.h"
#include "rt_core/contact/regions.h"
#include "rt_core/tool/articulate.h"

namespace palpate {

namespace {

// Region of a piece's contacts, or -1. One part is never two regions.
std::int32_t region_of(const Model& model, const State& state, std::size_t piece) {
  const ToolPiece& p = model.piece[piece];
  for (std::int32_t i = p.first_point; i < p.first_point + p.point_count; ++i) {
    const std::int32_t slot = state.point[i].region;
    if (slot >= 0 && slot < kMaxRegions && is_in_contact(state.region[slot])) return slot;
  }
  return -1;
}

FingerShape part_shape(const Model& model, const State& state, std::size_t piece, std::int32_t slot) {
  const ToolPiece& p = model.piece[piece];
  const Pose pose = carrier_w(model, state, static_cast<std::int32_t>(piece)) * p.pose_tool;
  FingerShape shape;
  shape.root_w = transform(pose, {0, 0, -p.half_extent_m[2]});
  shape.tip_w = transform(pose, {0, 0, p.half_extent_m[2]});
  shape.root_radius_m = shape.tip_radius_m = p.margin_m;
  shape.into_body_w = -state.region[slot].normal_w;
  return shape;
}

// Where `from`, which is inside, leaves the shape along its way into the body. Zero for a point that is not inside.
double way_out_m(const FingerShape& shape, Vec3 from) {
  if (!(distance_m(shape, from) < 0)) return 0;
  double low = 0, high = 2 * std::max(shape.root_radius_m, shape.tip_radius_m) + norm(shape.tip_w - shape.root_w);
  for (int k = 0; k < 50; ++k) {  // the shape is convex: one way out
    const double middle = 0.5 * (low + high);
    (distance_m(shape, from + middle * shape.into_body_w) < 0 ? low : high) = middle;
  }
  return high;
}

void flatten(const Model& model, const State& state, std::vector<Vec3>& position_m) {
  const auto palm = std::find_if(model.piece.begin(), model.piece.end(),
                                 [](const ToolPiece& piece) { return piece.part == kPalmPart; });
  if (palm == model.piece.end()) return;
  const Pose pose = state.tool_w * palm->pose_tool;
  const double x = palm->half_extent_m[0] + palm->margin_m, y = palm->half_extent_m[1] + palm->margin_m,
               face = palm->half_extent_m[2] + palm->margin_m;  // its inner side is -z
  for (Vec3& p : position_m) {
    const Vec3 local = inverse_transform(pose, p);
    if (std::abs(local.x) <= x && std::abs(local.y) <= y && local.z > -face && local.z < face)
      p = transform(pose, {local.x, local.y, -face});
  }
}

}  // namespace

double distance_m(const FingerShape& shape, Vec3 point_w) {
  const Vec3 along = shape.tip_w - shape.root_w, from_root = point_w - shape.root_w;
  const double length2 = squared_norm(along);
  const double u = length2 > 0 ? std::clamp(dot(from_root, along) / length2, 0.0, 1.0) : 0.0;
  return norm(from_root - u * along) - (shape.root_radius_m + u * (shape.tip_radius_m - shape.root_radius_m));
}

std::vector<FingerShape> finger_shapes(const Model& model, const State& state) {
  std::vector<FingerShape> shapes;
  if (model.params.articulation != Articulation::kHand) return shapes;
  std::int32_t last_slot = -1, last_group = -1;
  for (std::size_t p = 0; p < model.piece.size(); ++p) {  // roots before tips
    const std::int32_t slot = region_of(model, state, p);
    const std::int32_t group = model.piece[p].group;
    if (slot >= 0) {
      const FingerShape part = part_shape(model, state, p, slot);
      if (slot == last_slot && group == last_group) {
        const FingerShape& before = shapes.back();
        shapes.push_back({before.tip_w, part.root_w, before.tip_radius_m, part.root_radius_m, part.into_body_w, true});
      }
      shapes.push_back(part);
    }
    last_slot = slot;
    last_group = group;
  }
  return shapes;
}

void imprint(const Model& model, const State& state, std::vector<Vec3>& position_m) {
  if (model.params.articulation != Articulation::kHand) return;
  for (const FingerShape& shape : finger_shapes(model, state)) {
    for (Vec3& p : position_m) p += way_out_m(shape, p) * shape.into_body_w;
  }
  flatten(model, state, position_m);
}

}  // namespace palpate
