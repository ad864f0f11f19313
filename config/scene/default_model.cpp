#include "config/scene/default_model.h"

#include <algorithm>

#include "config/scene/config_error.h"
#include "config/tool/rounded_solid.h"

namespace palpate {

namespace {

constexpr const char* kModulus = "body.material.youngs_modulus_Pa";
// What a hand cannot tell from the object itself by half: it notices 6 to 7 % of a force.
constexpr const char* kErrorTarget = "3 %";

// What a method brings with it, unless the scene states otherwise.
void complete(SceneDesc& scene) {
  // An elastic body has no other tips than those of the pieces' shapes, one a piece.
  if (scene.contact.backend == Backend::kElastic) {
    if (!scene.source.has("contact.law")) scene.contact.law = ContactLaw::kTool;
    if (!scene.source.has("hand.points_per_part")) scene.hand.points_per_part = 1;
    take_apart_solids(scene);
  }
  // Whole tips have no points' springs: of the laws they take, the default is the one without a constant to choose.
  if (!scene.source.has("friction.law") && scene.contact.backend != Backend::kNodal && is_tip_law(scene.contact.law))
    scene.friction.law = FrictionLaw::kMindlin;
}

// The elastic body is what the presses are made of, and the dearest of the models that are tried.
void aim(SceneDesc& scene, double target) {
  constexpr std::int32_t kPresses = 5;
  if (!scene.source.has("contact.backend")) scene.contact.backend = Backend::kElastic;
  scene.elastic.check_error = target;
  if (scene.elastic.check_presses < 0) scene.elastic.check_presses = kPresses;
}

// A scene that says nothing of the elastic body either: it would be pressed by elements in any case.
bool leaves_error_open(const SceneDesc& scene) {
  return scene.error_target.empty() &&
         std::ranges::none_of(scene.source.line, [](const auto& key) { return key.first.starts_with("body.elastic"); });
}

// The scene with what its method brings, if that takes all that it states.
bool takes_every_key(SceneDesc& scene) {
  try {
    complete(scene);
    check_scene(scene);
    check_effects(scene);
    return true;
  } catch (const ConfigError&) {
    return false;
  }
}

bool try_elastic(SceneDesc& scene) {
  if (scene.articulation != Articulation::kRigid) return false;
  SceneDesc elastic = scene;
  elastic.contact.backend = Backend::kElastic;
  if (!takes_every_key(elastic)) return false;
  elastic.default_model = std::string("an elastic body, since ") + kModulus +
                          " is stated and no law of contact is; contact.backend or contact.law says otherwise";
  if (leaves_error_open(scene)) {
    elastic.error_target = kErrorTarget;
    aim(elastic, error_target_share(elastic));
    elastic.default_model += std::string("; or a cheaper model within error_target = \"") + kErrorTarget + "\" of it";
  }
  scene = std::move(elastic);
  return true;
}

bool try_hertz(SceneDesc& scene) {
  SceneDesc hertz = scene;
  hertz.contact.law = ContactLaw::kHertz;
  if (!takes_every_key(hertz)) return false;
  hertz.default_model = std::string("Hertz' law of tool points, since ") + kModulus +
                        " is stated, no law of contact is, and an elastic body does not take all that the scene "
                        "states; contact.law says otherwise, contact.backend = \"elastic\" what is not taken";
  scene = std::move(hertz);
  return true;
}

}  // namespace

void choose_default_model(SceneDesc& scene) {
  const bool open = !scene.source.has("contact.law") && !scene.source.has("contact.backend");
  if (const double target = error_target_share(scene); !is_auto(target) && !scene.source.has("contact.law"))
    aim(scene, target);
  else if (open && scene.source.has(kModulus) && (try_elastic(scene) || try_hertz(scene)))
    return;
  complete(scene);
}

}  // namespace palpate
