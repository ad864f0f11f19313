// Which law of contact a scene means that names none.
#pragma once

#include "config/scene/scene.h"

namespace palpate {

// Sets backend, law and what follows from them where the scene leaves them open; part of load_scene, before its checks.
// Who states E means it to be felt: a scene with body.material.youngs_modulus_Pa and neither contact.law nor
// contact.backend gets the first of the elastic body (a rigid tool's alone: a hand's is dear, docs/models_elastic.md)
// and Hertz' law of tool points that takes every key the scene states. Without E it is Duffing's, of which no material
// follows. What was taken is said in scene.default_model.
void choose_default_model(SceneDesc& scene);

}  // namespace palpate
