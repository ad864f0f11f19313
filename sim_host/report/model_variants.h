// Every model of the product for one physical case: the scene's body, material and support, pressed by a frictionless
// ball.
#pragma once

#include <span>
#include <string>

#include "config/scene/scene.h"

namespace palpate {

// A straight press: the ball's centre starts above `place_m`, which is on the surface at rest, and goes in along
// -`normal`.
struct PressPlace {
  Vec3 place_m, normal{0, 1, 0};
  double radius_m = 0;
  double depth_m = 0;  // deepest
};

struct ModelVariant {
  const char* name;
  const char* family;   // what of it is drawn alike
  const char* meaning;  // one phrase
  void (*choose)(SceneDesc& scene, const PressPlace& press);
};
std::span<const ModelVariant> model_variants();
// Null when there is none of that name.
const ModelVariant* find_variant(const std::string& name);

// The case as this model takes it. Throws ConfigError where it cannot.
SceneDesc scene_of(const ModelVariant& variant, const SceneDesc& stated, const PressPlace& press);

}  // namespace palpate
