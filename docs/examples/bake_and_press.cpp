// Bakes a scene in this process and presses its tool into the body: force against depth, for any plotter.
#include <cstdio>
#include <exception>

#include "sim_host/palpate_host.h"

using namespace palpate;

int main(int argc, char** argv) try {
  if (argc != 2) return std::puts("usage: bake_and_press SCENE.toml"), 2;
  const SceneModel scene(argv[1]);
  const StatePtr state = make_state(scene.model());
  const ScratchPtr scratch = make_scratch(scene.model());
  Input input;
  input.drive = Drive::kTool;
  Output output;
  std::puts("depth_mm,force_N");
  for (int i = 0; i <= 200; ++i) {
    input.pose_w.position_m = {-0.010, 0.080 - 0.0001 * i, 0};
    tick(scene.model(), *state, *scratch, input, output);
    if (output.contacts > 0) std::printf("%.3f,%.4f\n", 1e3 * output.penetration_m, output.contact_w.force_N.y);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
