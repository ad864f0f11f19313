// Two fingers that squeeze a body which is its own mirror image, element by element: what one feels the other feels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/scene/scene.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

struct Squeeze {
  double largest_N = 0, apart_N = 0, held_apart_N = 0;
};

// The shipped scene's jaws close and hold, along x as shipped or along z. `apart`: the largest difference between the
// force on one jaw and the mirror image of that on the other, over all ticks; `held_apart`: at the end.
Squeeze squeeze(SceneDesc desc, bool along_z) {
  if (along_z)
    for (PieceDesc& piece : desc.piece) {
      std::swap(piece.position_m.x, piece.position_m.z);
      std::swap(piece.slide_m.x, piece.slide_m.z);
      piece.rotation_rad = {0, 0.5 * std::acos(-1.0), 0};
    }
  const BakedScene scene(desc);
  Bench bench(scene.model());
  Squeeze seen;
  for (int k = 0; k < 1500; ++k) {
    bench.tick_at({{0, 0.020, 0}, {}}, closing_all(1));
    const auto& force = bench.state->articulation.piece_force_tool_N;
    Vec3 image = force[1];
    (along_z ? image.z : image.x) *= -1;
    seen.held_apart_N = norm(force[0] - image);
    seen.apart_N = std::max(seen.apart_N, seen.held_apart_N);
    seen.largest_N = std::max(seen.largest_N, norm(force[0]));
  }
  EXPECT_EQ(bench.output.regions, 2);
  EXPECT_GT(seen.largest_N, 5);
  return seen;
}

SceneDesc pinch_scene(FrictionLaw friction, FemPrecision precision) {
  SceneDesc desc = load_scene(PALPATE_SOURCE_DIR "/config/scenes/pinch_block_nodal.toml");
  desc.friction.law = friction;
  desc.fem.precision = precision;
  return desc;
}

// Elimination does not follow the mirror, so that the table's entries differ by rounding: 3e-14 N in double precision;
// in single precision some of them fall to the other neighbour, 1.4e-7 N of 6.0 N. Along z one tick, whose 64
// candidates fill the pool, is 9.5e-8 N off in double precision too (2026-11-21).
TEST(PinchSymmetry, FrictionlessFingersAgreeToRounding) {
  for (const bool along_z : {false, true})
    for (const bool twice : {false, true}) {
      const Squeeze seen =
          squeeze(pinch_scene(FrictionLaw::kNone, twice ? FemPrecision::kDouble : FemPrecision::kSingle), along_z);
      std::printf("pinch along %s, %s precision: %.4f N, at most %.1e N apart, held %.1e N\n", along_z ? "z" : "x",
                  twice ? "double" : "single", seen.largest_N, seen.apart_N, seen.held_apart_N);
      EXPECT_LT(seen.apart_N, 1e-7 * seen.largest_N);
      EXPECT_LT(seen.held_apart_N, (twice ? 1e-13 : 1e-7) * seen.largest_N);
    }
}

// Friction sweeps visit the nodes one after another and end after kMaxFrictionVisits: that order is not symmetric. 0.13
// % along x (2026-11-21); 2e-5 when the sweeps go on.
TEST(PinchSymmetry, FrictionLeavesTheErrorOfItsSweeps) {
  for (const bool along_z : {false, true}) {
    const Squeeze seen = squeeze(pinch_scene(FrictionLaw::kCoulomb, FemPrecision::kSingle), along_z);
    std::printf("pinch along %s, with friction: %.4f N, at most %.1e N apart\n", along_z ? "z" : "x", seen.largest_N,
                seen.apart_N);
    EXPECT_LT(seen.apart_N, 0.01 * seen.largest_N);
  }
}

}  // namespace
}  // namespace palpate::test
