// The rim of what is held runs along edges of the surface, whatever the surface and wherever the region ends.
#include <gtest/gtest.h>

#include <cmath>

#include "config/body/body.h"
#include "config/body/support_rim.h"
#include "config/body/supports.h"
#include "tests/support/baked_scene.h"

namespace palpate {
namespace {

struct Rimmed {
  Rimmed(const std::string& body, const std::string& fixed)
      : scene(parse_scene(
            "name = \"rim\"\n[body]\n" + body + fixed + "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n",
            "s.toml")) {
    std::vector<std::string> warnings;
    before = after = make_body(scene, warnings);
    lay_support_rims(scene, after);
  }
  // Longest edge between a held and a free corner that leaves the region before its free end, of its length: how far
  // from the held corner the region ends.
  double worst_rim() const {
    const double lowest = bounds_of(before).lower_m.y;
    const auto held = [&](Vec3 x) { return is_fixed(scene, x, lowest); };
    double worst = 0;
    for (const Corners& t : after.triangle)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 a = after.vertex_m[static_cast<std::size_t>(t[k])],
                   b = after.vertex_m[static_cast<std::size_t>(t[(k + 1) % 3])];
        if (!held(a) || held(b)) continue;
        int inside = 0;
        while (held(a + (0.01 * (inside + 1)) * (b - a))) ++inside;
        worst = std::max(worst, std::min(0.01 * inside, 1 - 0.01 * inside));
      }
    return worst;
  }
  SceneDesc scene;
  SurfaceMesh before, after;
};

const char* const kTube =
    "shape = \"hollow_cylinder\"\nradius_mm = 35\nheight_mm = 70\nwall_mm = 10\naxis = \"z\"\ntriangles = 1500\n";

void expect_whole(const Rimmed& rimmed, double volume_tolerance) {
  EXPECT_NO_THROW(check_mesh(rimmed.after, "rim"));  // closed, manifold, outward, no facet without an area
  EXPECT_NEAR(signed_volume_m3(rimmed.after) / signed_volume_m3(rimmed.before), 1, volume_tolerance);
  EXPECT_LE(rimmed.worst_rim(), 0.03);  // kAtCorner, and the step of the search
}

TEST(SupportRim, BasesOfATubeEndAlongEdges) {
  for (const char* const height : {"3.3", "6", "12.1", "35"}) {
    SCOPED_TRACE(height);
    // Corners go along chords to the rim: the volume loses a little of the arcs' sagitta.
    expect_whole({kTube, std::string("[body.fixed]\nbase_height_mm = ") + height + "\n"}, 5e-3);
  }
}

TEST(SupportRim, BoxesAndBallsEndAlongEdges) {
  expect_whole({"shape = \"ellipsoid\"\nhalf_axes_mm = [40, 30, 40]\ntriangles = 1200\n",
                "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [-50, -1, -50]\nto_mm = [-21.7, 70, 50]\n"
                "[[body.fixed]]\nregion = \"ball\"\ncentre_mm = [40, 30, 0]\nradius_mm = 17.3\n"},
               5e-3);
}

// Strips and spots narrower than the facets: on an edge that has no corner within, cuts beside it went to and fro ever
// nearer to it without an end (2026-11-28).
TEST(SupportRim, WhatIsNarrowerThanAFacetEndsAlongEdges) {
  const std::string block = "shape = \"box\"\nsize_mm = [40, 30, 40]\ntriangles = 300\n";  // facets of 8 mm
  for (const char* const region :
       {"from_mm = [-30, 20, -1.3]\nto_mm = [30, 40, 1.1]\n", "from_mm = [2.1, 25, 1.2]\nto_mm = [4.3, 31, 3.9]\n",
        "from_mm = [-20.5, 12.2, -20.5]\nto_mm = [-18.7, 14.1, 30]\n"}) {
    SCOPED_TRACE(region);
    const Rimmed rimmed(block, std::string("[[body.fixed]]\nregion = \"box\"\n") + region);
    expect_whole(rimmed, 1e-9);
    int held = 0;
    for (const Vec3& x : rimmed.after.vertex_m) held += is_fixed(rimmed.scene, x, 0) ? 1 : 0;
    EXPECT_GE(held, 4);
  }
}

// Before, the region ended in the middle of edges: the test can see that.
TEST(SupportRim, WithoutItRegionsEndWithinEdges) {
  Rimmed rimmed(kTube, "[body.fixed]\nbase_height_mm = 6\n");
  rimmed.after = rimmed.before;
  EXPECT_GT(rimmed.worst_rim(), 0.2);
}

}  // namespace
}  // namespace palpate
