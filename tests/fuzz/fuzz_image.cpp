// Scene images: whatever open_image accepts may be ticked, stays finite and within its own limits.
#include <cmath>
#include <cstdlib>
#include <memory>

#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/fuzz/edits.h"
#include "tests/support/tiny_image.h"

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  test::ImageBytes image = test::tiny_image();
  const ImageHeader before = image.header();
  fuzz::apply_all(data, size, image.bytes());
  // The rungs below the checksum have exhaustive tests; here the ladder is climbed beyond them.
  image.header().magic = before.magic;
  image.header().version = before.version;
  image.header().real_bytes = before.real_bytes;
  image.header().layout_hash = before.layout_hash;
  image.header().total_bytes = before.total_bytes;
  image.seal();
  Model model;
  if (open_image(image.bytes(), model).error != ImageError::kNone) return 0;
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  for (int i = 0; i < 12; ++i) {
    Input input;
    input.pose_w.position_m = {0.01, 0.005 + 1e-4 * i, 0.03 - 2e-3 * i};
    input.commands = i > 1 ? Command::kArm : 0;
    Output output;
    tick(model, *state, *scratch, input, output);
    const double force = norm(output.device_w.force_N), torque = norm(output.device_w.torque_Nm);
    if (!(force <= model.params.force_max_N * (1 + 1e-9) && torque <= model.params.torque_max_Nm * (1 + 1e-9))) abort();
  }
  return 0;
}
