// Which facet of a part a place is above, against all facets of that part.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "config/bake/surface_parts.h"
#include "config/scene/scene.h"
#include "rt_core/contact/elastic/part_search.h"
#include "rt_core/surface/triangle.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

struct Seen {
  double distance_m;
  bool faces;
};
Seen seen(const Model& model, std::int32_t triangle, Vec3 from) {
  const std::int32_t* v = model.triangle[static_cast<std::size_t>(triangle)].vertex;
  const Vec3 a = model.vertex_m[static_cast<std::size_t>(v[0])], b = model.vertex_m[static_cast<std::size_t>(v[1])],
             c = model.vertex_m[static_cast<std::size_t>(v[2])];
  return {norm(from - closest_on_triangle(from, a, b, c).point), dot(from - a, cross(b - a, c - a)) > 0};
}

// From wherever a foot is, within a few ticks. Nearest of what looks at the place: what looks away is behind the body.
TEST(PartSearch, FindsTheNearestFacetOfAClipsPartsFromAnywhere) {
  const BakedScene baked(load_scene(PALPATE_SOURCE_DIR "/config/scenes/snap_in.toml"));
  const Model& model = baked.model();
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> away_m(0.015, 0.05);
  int asked = 0, found = 0;
  for (const ToolPoint& point : model.tool_point) {
    const PartSeeds seeds = spread_over_part(model, point.begins_at);
    const std::vector<std::int32_t> part = part_of(model, point.begins_at);
    std::int32_t foot = point.begins_at;
    for (int i = 0; i < 300; ++i) {
      const Vec3 from = away_m(random) * unit_or({normal(random), normal(random), 0.3 * normal(random)}, {0, 1, 0});
      double nearest_m = kHuge;
      for (const std::int32_t t : part)
        if (const Seen s = seen(model, t, from); s.faces) nearest_m = std::min(nearest_m, s.distance_m);
      bool is_there = false;
      for (int tick = 0; tick < 20 && !is_there; ++tick) {
        const PartPlace place = come_down(model, seeds, from, foot);
        EXPECT_LE(place.looked, kMostPartLooks);
        foot = place.triangle;
        is_there = place.is_there;
      }
      EXPECT_TRUE(is_there);
      EXPECT_TRUE(std::find(part.begin(), part.end(), foot) != part.end());
      if (!(nearest_m < kHuge)) continue;
      asked += 1;
      found += seen(model, foot, from).distance_m < nearest_m + 1e-4 ? 1 : 0;
    }
  }
  RecordProperty("found", std::to_string(found) + " of " + std::to_string(asked));
  EXPECT_GT(asked, 1000);
  EXPECT_GT(found, 0.99 * asked);
}

// What asks from nowhere, as a state spoilt in memory does, stays where it is.
TEST(PartSearch, StaysWhereItIsWhenThePlaceIsNoNumber) {
  const BakedScene baked(load_scene(PALPATE_SOURCE_DIR "/config/scenes/snap_in.toml"));
  const Model& model = baked.model();
  const std::int32_t begins_at = model.tool_point[0].begins_at;
  const PartSeeds seeds = spread_over_part(model, begins_at);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3 from : {Vec3{nan, 0, 0}, Vec3{nan, nan, nan}, Vec3{0, kHuge * kHuge * kHuge, 0}}) {
    const PartPlace place = come_down(model, seeds, from, begins_at);
    EXPECT_GE(place.triangle, 0);
    EXPECT_LT(place.triangle, model.sizes.n_triangle);
  }
}

}  // namespace
}  // namespace palpate::test
