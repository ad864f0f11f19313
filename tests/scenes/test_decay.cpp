// No number of a state ever comes near the smallest ones there are: what decays ends (rt_core/decay.h). There
// processors differ in what they flush, and there a hand that keeps still would feel something change for ever.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/scenes/scene_names.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

// Half of the 308 decades below one: nothing at 1e-150 is near the end, and its square is none that is stored.
constexpr double kTiny = 1e-150;

struct TinyNumbers {
  static constexpr bool kRealTime = false;
  std::string found;  // names of the fields that hold one
  void enter(const char*, std::int32_t) {}
  void leave() {}
  void skip(const char*, std::int32_t) {}
  void look(const char* name, double x) {
    if (x != 0 && std::abs(x) < kTiny && found.find(name) == std::string::npos) found += std::string(name) + " ";
  }
  void look(const char* name, Vec3 v) {
    for (const double x : {v.x, v.y, v.z}) look(name, x);
  }
  template <class T>
  void value(const char* name, const T& x) {
    if constexpr (std::is_same_v<T, double> || std::is_same_v<T, Vec3>) {
      look(name, x);
    } else if constexpr (std::is_same_v<T, Pose>) {
      look(name, x.position_m);
      look(name, {x.orientation.x, x.orientation.y, x.orientation.z});
    } else if constexpr (std::is_same_v<T, Wrench>) {
      look(name, x.force_N);
      look(name, x.torque_Nm);
    }
  }
};

// Without the floor 2^-1022 itself is met in 17 of 21 scenes, in the tool's pose, the last outputs and the hand's
// velocity (2026-11-24).
TEST(Decay, EndsBeforeTheSmallestNumbers) {
  for (const std::string& scene : scene_names()) {
    const ImageFile image(std::string(PALPATE_IMAGE_DIR) + "/" + scene + ".pal");
    const StatePtr state = make_state(image.model());
    const ScratchPtr scratch = make_scratch(image.model());
    ScriptedHand hand(image.model());
    Output output;
    TinyNumbers tiny;
    for (int i = 0; i < kScriptTicks; ++i) {
      tick(image.model(), *state, *scratch, hand.next(output), output);
      if (i % 4 == 0) state->visit_all(tiny);
    }
    EXPECT_EQ(tiny.found, "") << scene;
  }
}

}  // namespace
}  // namespace palpate::test
