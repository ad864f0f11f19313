// The list of scenes, tools and materials that a run can go over to, and what has become of the wish.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "sim_host/view/scene_change.h"

namespace palpate {

class SceneList {
 public:
  // Offers what lies beside the run's first scene, and `also`.
  SceneList(SceneChoice first, const std::vector<std::string>& also);
  void toggle() { shown_ = !shown_; }
  // Over the given rectangle, while it is shown.
  void draw(ImVec2 low, ImVec2 size, SceneChange& change);

 private:
  void scenes(float height);
  void overlays(float height);
  void choose(const std::string& scene);
  void follow(const SceneChoice& now);
  void lay(const OverlayGroup& group, const std::string& file);
  bool is_laid(const std::string& file) const;

  SceneChoice first_, chosen_;
  SceneOffer offer_;
  std::vector<std::vector<std::string>> misfit_;  // of every overlay: why it does not go on the chosen scene, or ""
  std::string followed_;                          // key of the run's scene that was chosen here because it came
  bool shown_ = false;
};

// How far a change is, or why it was refused, in words; nothing when nobody asked, and soon after it has happened.
void change_news(const SceneChange::News& news);

}  // namespace palpate
