#include "rt_core/surface/smooth_foot.h"

#include "rt_core/surface/foot_search.h"

namespace palpate {

namespace {

foot::Corners corners_of(const Model& model, std::int32_t triangle) PALPATE_RT {
  const auto index = static_cast<std::size_t>(triangle);
  const Triangle& t = model.triangle[index];
  foot::Corners c;
  for (int k = 0; k < 3; ++k) {  // bound: 3
    c.v[k] = model.vertex_m[static_cast<std::size_t>(t.vertex[k])];
    c.u[k] = model.corner_normal[index].normal[k];
  }
  return c;
}

}  // namespace

SmoothFoot smooth_foot(const Model& model, Vec3 p, std::int32_t triangle) PALPATE_RT {
  std::int32_t steps = 0, passed = 0;
  SmoothFoot foot = foot::search<false>(
      model, [&model](std::int32_t t) PALPATE_RT { return corners_of(model, t); },
      [](int, Vec3 off) PALPATE_RT { return off; }, p, triangle, p, foot::kStill_m, kFootWalk, &steps, &passed);
  foot.steps = steps + passed / foot::kSpokesPerStep;
  return foot;
}

void facet_weights(const Model& model, std::int32_t triangle, Vec3 at, Real (&weight)[3]) PALPATE_RT {
  const foot::Place place = foot::place_on(corners_of(model, triangle), at, 0.0);
  weight[1] = clamp_to(place.b, 0.0, 1.0);
  weight[2] = clamp_to(place.c, 0.0, 1.0 - weight[1]);
  weight[0] = 1.0 - weight[1] - weight[2];
}

}  // namespace palpate
