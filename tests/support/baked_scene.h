// A scene baked from text in memory and ticked by hand: no file, no process, no device.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "config/bake/compile.h"
#include "config/bake/opened_image.h"
#include "rt_core/image.h"
#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"

namespace palpate::test {

class BakedScene {
 public:
  explicit BakedScene(const SceneDesc& scene) : BakedScene(compile_scene(scene)) {}
  explicit BakedScene(const std::string& text) : BakedScene(parse_scene(text, "test.toml")) {}
  BakedScene(const BakedScene&) = delete;
  BakedScene& operator=(const BakedScene&) = delete;
  const Model& model() const { return image_.model(); }
  // For tests that change a parameter after baking.
  Model& model() { return image_.model(); }

  CompileReport report;

 private:
  explicit BakedScene(const CompileResult& baked) : report(baked.report), image_(baked.bytes) {
    if (image_.result().error != ImageError::kNone)
      throw std::runtime_error(std::string("image: ") + image_.result().field);
  }
  OpenedImage image_;
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
