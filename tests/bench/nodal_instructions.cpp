// The dearest ticks of contact on finite elements for callgrind: a flat plate on a block whose top has sixty nodes, all
// of which push and slip. Each tick is counted alone like those of tick_instructions.cpp. Parts: `slide`: the plate
// lands, presses and is drawn to and fro at up to 0.2 m/s; `rock`: it also rocks over the block, so that nodes open and
// close at its edges. Usage: valgrind --tool=callgrind --collect-atstart=no ... nodal_instructions slide|rock
#include <valgrind/callgrind.h>

#include <cmath>
#include <cstdio>
#include <cstring>
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

NodalSceneOptions options_for(const TetMesh& mesh, const CondensedBody& body, const Supports& base) {
  NodalSceneOptions options;
  options.young_Pa = 2e5;
  options.poisson = 0.3;
  options.mu = 0.3;
  options.precision = CompliancePrecision::kSingle;
  const LinearBody solver(mesh, {options.young_Pa, options.poisson}, base, "block");
  for (const double e : place_strain_gauges(solver, mesh, body, kMaxStrainGauges).strain_1pN)
    options.strain_gauge.push_back(static_cast<float>(e));
  return options;
}

// Where the handle is: the tool hangs on it by the virtual coupling.
Pose handle_at(int k, bool rocks) {
  const double press = 3e-4 * (k < 40 ? k + 1 : 40);
  const double phase = 2 * 3.14159265358979 * (k - 40) / 120;
  const double slide = k < 40 ? 0 : 4e-3 * std::sin(phase);
  const double tilt = rocks && k >= 40 ? 0.02 * std::sin(2 * phase) : 0;
  return {{slide, kTop_m + 0.005 - press, 0.5 * slide}, small_rotation({0.0, 0.0, tilt})};
}

void play(bool rocks) {
  const TetMesh mesh = block();
  const Supports base = hold_where(mesh, [](Vec3 x) { return x.y < 1e-9; });
  const CondensedBody body = condense(mesh, {2e5, 0.3}, base, "block");
  NodalScene scene(body, {plate()}, options_for(mesh, body, base));
  scene.params().friction_sweeps = 4;  // what the scenes ask for
  scene.reopen();
  for (int k = 0; k < kTicks; ++k) {
    const Pose handle = handle_at(k, rocks);
    CALLGRIND_TOGGLE_COLLECT;
    const Output& output = scene.tick_at(handle.position_m, Drive::kDevice, handle.orientation);
    CALLGRIND_TOGGLE_COLLECT;
    int slips = 0;
    for (int i = 0; i < problem_of(scene.scratch()).count; ++i)
      slips += problem_of(scene.scratch()).node[i].push.slips ? 1 : 0;
    char label[96];
    std::snprintf(label, sizeof(label), "tick %d contacts %d regions %d exchanges %d slipping %d", k, output.contacts,
                  output.regions, problem_of(scene.scratch()).normal.pivots - 1, slips);
    CALLGRIND_DUMP_STATS_AT(label);
  }
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  const bool rocks = argc == 2 && std::strcmp(argv[1], "rock") == 0;
  if (argc != 2 || (!rocks && std::strcmp(argv[1], "slide") != 0)) {
    std::fprintf(stderr, "usage: nodal_instructions slide|rock\n");
    return 2;
  }
  try {
    palpate::test::play(rocks);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nodal_instructions: %s\n", error.what());
    return 2;
  }
  return 0;
}
