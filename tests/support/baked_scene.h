// A scene baked from text in memory and ticked by hand: no file, no process, no device.
#pragma once

#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/bake/compile.h"
#include "rt_core/image.h"
#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"

namespace palpate::test {

class BakedScene {
 public:
  explicit BakedScene(const SceneDesc& scene) {
    CompileResult baked = compile_scene(scene);
    report = baked.report;
    blocks_.resize((baked.bytes.size() + kImageAlignment - 1) / kImageAlignment);
    std::memcpy(static_cast<void*>(blocks_.data()), baked.bytes.data(), baked.bytes.size());
    const ImageResult opened =
        open_image({reinterpret_cast<const std::byte*>(blocks_.data()), baked.bytes.size()}, model_);
    if (opened.error != ImageError::kNone) throw std::runtime_error(std::string("image: ") + opened.field);
  }
  explicit BakedScene(const std::string& text) : BakedScene(parse_scene(text, "test.toml")) {}
  BakedScene(const BakedScene&) = delete;
  BakedScene& operator=(const BakedScene&) = delete;
  const Model& model() const { return model_; }
  // For tests that change a parameter after baking.
  Model& model() { return model_; }

  CompileReport report;

 private:
  struct alignas(kImageAlignment) Block {
    std::byte bytes[kImageAlignment];
  };
  std::vector<Block> blocks_;
  Model model_;
};

// Ticks a model with the tool held at given poses (Drive::kTool).
struct Bench {
  explicit Bench(const Model& scene) : model(scene) { reset(*state); }
  const Output& tick_at(const Pose& tool_w, const JointCommand& joints) {
    Input input;
    input.drive = Drive::kTool;
    input.pose_w = tool_w;
    input.joints = joints;
    tick(model, *state, *scratch, input, output);
    return output;
  }

  const Model& model;
  StatePtr state = make_state(model);
  ScratchPtr scratch = make_scratch(model);
  Output output;
};

inline JointCommand closing_all(double fraction) {
  JointCommand joints;
  for (float& closing : joints.closing) closing = static_cast<float>(fraction);
  return joints;
}

}  // namespace palpate::test
