// The clip of Duriez, Andriot & Kheddar (2003, section 5) snapped over a rigid tube.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/nodal/nodal_scene.h"

namespace palpate::test {
namespace {

constexpr double kFirstContact_m = 0.01414133;

TEST(Snap, Explore) {
  for (int level = 1; level <= 3; ++level) {
    const TetMesh mesh = make_clip_mesh(level);
    const CondensedBody body = condense(mesh, {2e9, 0.35}, clip_supports(mesh), "clip");
    for (const NodalCarry carry : {NodalCarry::kFarField}) {
      NodalSceneOptions options;
      options.young_Pa = 2e9;
      options.poisson = 0.35;
      options.carry = carry;
      NodalScene scene(body, {cylinder_piece(0.010, 0.040, 0.001)}, options);
      std::printf("level %d nodes %zu carry %d\n", level, body.surface.vertex_m.size(), static_cast<int>(carry));
      double d = -0.0005;
      for (int k = 0; k <= 145; ++k) {
        d = 1e-4 * k;
        scene.move({0, kFirstContact_m - d + 1e-4, 0}, {0, kFirstContact_m - d, 0}, 4);
        const Output& o = scene.output();
        if (k % 10 == 5 || k % 10 == 0)
          std::printf("%5.2f mm F %8.4f %8.4f %8.4f n %d cand %d reg %d res %.1e piv %d st %x share %.3f E %.4f\n",
                      d * 1e3, o.contact_w.force_N.x, o.contact_w.force_N.y, o.contact_w.force_N.z, o.contacts,
                      scene.scratch().nodal.count, o.regions, o.residual_m, scene.scratch().nodal.normal.pivots,
                      o.status, scene.state().nodal.far_share, 1e3 * o.energy_J);
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
