// What a run may go over to: scenes and images of a folder, changed by the overlays that lie in the folders below it.
#pragma once

#include <string>
#include <vector>

#include "config/scene/scene.h"

namespace palpate {

// A scene (.toml) with what is laid over it, or an image (.pal) as it is.
struct SceneChoice {
  std::string scene;
  SceneOverlays overlays;
  // In which all equal, the images are.
  std::string key() const;
};

// "tools_on_layer + cone_30 + brain"
std::string title_of(const SceneChoice& choice);
bool is_image(const std::string& file);

// Overlays of one folder, "tools": they replace one another, so that one of them at most is laid over a scene.
struct OverlayGroup {
  std::string name;
  std::vector<std::string> file;
};
struct SceneOffer {
  std::vector<std::string> scene;  // .toml and .pal
  std::vector<OverlayGroup> group;
};
// What lies beside `scene`: scenes and images in its folder, overlays in the folders of that; and `also`, scenes and
// images of any other place. By name, each once.
SceneOffer offer_beside(const std::string& scene, const std::vector<std::string>& also = {});

// What a choice says of itself before it is baked: "" when the file is there and its keys go together, otherwise why
// not.
std::string why_not(const SceneChoice& choice);

// "SCENE [OVERLAY...] [KEY=VALUE...]", SCENE "." for that of `now`: files as they are named, or as the list has them:
// in the folder of `now`'s scene, without ".toml". Throws std::runtime_error naming what is not there.
SceneChoice choice_of(const std::string& words, const SceneChoice& now);

}  // namespace palpate
