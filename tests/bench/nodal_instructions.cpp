// The dearest ticks of contact on finite elements for callgrind: a flat plate that lands on sixty surface nodes, presses
// all of them, slides over them with Coulomb friction, tilts, leaves at full depth and comes back in one tick. Counted
// like tick_instructions.cpp. Usage: valgrind --tool=callgrind --collect-atstart=no ... nodal_instructions
#include <valgrind/callgrind.h>

#include <cstdio>
#include <exception>

#include "config/fem/strain_gauges.h"
#include "tests/nodal/nodal_scene.h"

namespace palpate::test {
namespace {

constexpr double kTop_m = 0.024;
constexpr int kTicks = 400;

PieceDesc plate() {
  PieceDesc piece;
  piece.shape = PieceShape::kBox;
  piece.size_m = {0.080, 0.010, 0.080};
  piece.margin_m = 1e-3;
  piece.points = 8;
  return piece;
}

// Linear elements: under a flat plate every node of the face pushes, also the corners of quadratic ones would not.
TetMesh block() {
  TetMesh mesh = make_box_tets({0.024, kTop_m, 0.040}, {5, 3, 9});
  for (Tet& tet : mesh.tet) {
    Tet linear;
    for (std::size_t k = 0; k < 4; ++k) linear.node[k] = tet.node[k];
    tet = linear;
  }
  mesh.node_m.resize(6 * 4 * 10);
  return mesh;
}

struct Place {
  Vec3 position_m;
  Quat orientation;
};

Place place_at(int k) {
  const double press = k < 40 ? 5e-5 * (k + 1) : 2e-3;
  const double phase = 2 * 3.14159265358979 * (k - 40) / 120;
  const double slide = k < 40 ? 0 : 4e-3 * std::sin(phase);
  const double tilt = k < 200 || k >= 320 ? 0 : 0.02 * std::sin(2 * phase);
  return {{slide, kTop_m + 0.005 - press, 0.5 * slide}, small_rotation({0.0, 0.0, tilt})};
}

void play() {
  NodalSceneOptions options;
  options.young_Pa = 2e5;
  options.poisson = 0.3;
  options.mu = 0.3;
  options.precision = CompliancePrecision::kSingle;
  const TetMesh mesh = block();
  const FemMaterial material{options.young_Pa, options.poisson};
  const Supports base = hold_where(mesh, [](Vec3 x) { return x.y < 1e-9; });
  const CondensedBody body = condense(mesh, material, base, "block");
  const LinearBody solver(mesh, material, base, "block");
  for (const double e : place_strain_gauges(solver, mesh, body, kMaxStrainGauges).strain_1pN)
    options.strain_gauge.push_back(static_cast<float>(e));
  NodalScene scene(body, {plate()}, options);
  scene.params().friction_sweeps = std::getenv("SW") ? std::atoi(std::getenv("SW")) : 4;  // what the scenes use
  scene.reopen();
  int most = 0;
  for (int k = 0; k < kTicks; ++k) {
    const Place place = place_at(k);
    CALLGRIND_TOGGLE_COLLECT;
    const Output& output = scene.tick_at(place.position_m, Drive::kDevice, place.orientation);
    CALLGRIND_TOGGLE_COLLECT;
    int slips = 0;
    for (int i = 0; i < scene.scratch().nodal.count; ++i) slips += scene.scratch().nodal.node[i].push.slips ? 1 : 0;
    char label[96];
    std::snprintf(label, sizeof(label), "tick %d contacts %d regions %d pivots %d slipping %d", k, output.contacts,
                  output.regions, scene.scratch().nodal.normal.pivots, slips);
    CALLGRIND_DUMP_STATS_AT(label);
    std::printf("%s candidates %d residual %.1e status %llx F %.3f %.3f %.3f\n", label, scene.scratch().nodal.count, output.residual_m, static_cast<unsigned long long>(output.status), output.contact_w.force_N.x, output.contact_w.force_N.y, output.contact_w.force_N.z);
    most = std::max(most, output.contacts);
  }
  std::printf("most contacts %d\n", most);
}

}  // namespace
}  // namespace palpate::test

int main() {
  try {
    palpate::test::play();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nodal_instructions: %s\n", error.what());
    return 2;
  }
  return 0;
}
