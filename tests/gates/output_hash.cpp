// Plays the scripted hand in baked scenes and prints one hash of all outputs per scene: what effect.sh compares.
// Usage: output_hash IMAGE...
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>

#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

class Hash {
 public:
  void add(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x9E3779B97F4A7C15ull;
    value_ ^= value_ >> 29;
  }
  void add(Real value) {
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof(word));
    add(word);
  }
  void add(const Vec3& v) { add(v.x), add(v.y), add(v.z); }
  void add(const Wrench& w) { add(w.force_N), add(w.torque_Nm); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0;
};

void add(const Output& o, Hash& hash) {
  for (const Wrench& w : {o.device_w, o.contact_w, o.palm_w}) hash.add(w);
  hash.add(o.tool_w.position_m);
  for (const Real x : {o.penetration_m, o.energy_J, o.residual_m, o.strain, o.ramp}) hash.add(x);
  hash.add(static_cast<std::uint64_t>(o.status) << 32 | o.fault);
  hash.add(static_cast<std::uint64_t>(o.mode));
  hash.add(static_cast<std::uint64_t>(o.regions) << 32 | static_cast<std::uint32_t>(o.contacts));
}

std::uint64_t play(const Model& model) {
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  Output output;
  ScriptedHand hand(model);
  Hash hash;
  for (int i = 0; i < kScriptTicks; ++i) {
    tick(model, *state, *scratch, hand.next(output), output);
    add(output, hash);
  }
  return hash.value();
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  try {
    for (int i = 1; i < argc; ++i) {
      const palpate::test::ImageFile image(argv[i]);
      std::printf("%s %016llx\n", image.model().name,
                  static_cast<unsigned long long>(palpate::test::play(image.model())));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "output_hash: %s\n", error.what());
    return 2;
  }
  return argc > 1 ? 0 : 2;
}
