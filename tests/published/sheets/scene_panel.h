// Pictures of shipped scenes for contact sheets: a press played to a moment, drawn with the beams of its skeleton.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim_host/bake/scene_model.h"
#include "sim_host/press/press.h"
#include "sim_host/tick_memory.h"
#include "sim_host/view/orbit_camera.h"
#include "tests/published/sheets/sheet.h"

namespace palpate::papers {

// A scene of config/scenes, by name, with overlays by their paths there.
SceneModel shipped(const std::string& name, const std::vector<std::string>& overlays = {},
                   const std::vector<std::string>& settings = {});

struct Moment {
  StatePtr state;
  std::vector<Contact> contact;  // of that tick
};
// The scene's own scripted motion, or `poses` with the tool held at them, up to `time_s`.
Moment moment_of(const SceneModel& scene, double time_s);
Moment moment_of(const SceneModel& scene, const std::vector<TimedPose>& poses, double time_s);
// Whatever the tool of a scene does before anything has moved.
Moment at_rest(const SceneModel& scene);

using Line3 = std::vector<Vec3>;
// Straight beams from every region in contact to every anchor, as it stands displaced; to the other regions, too, where
// `mutual`.
std::vector<Line3> straight_beams(const Model& model, const State& state, bool mutual = false);
// Circular beams from the surface vertex nearest to the contact to every anchor.
std::vector<Line3> circular_beams(const SceneModel& scene, const State& state);

struct PanelView {
  std::optional<StandardView> view;
  double displacement_max_m = 0;
  bool tool = true;  // false: the body alone fills the panel
};
inline PanelView body_alone() { return {{}, 0, false}; }
inline PanelView colours_to(double displacement_m) { return {{}, displacement_m, true}; }
Canvas scene_panel(const Model& model, const State& state, const std::vector<Line3>& beams = {},
                   const PanelView& view = {});

}  // namespace palpate::papers
