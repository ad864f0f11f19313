// The panel of the viewer: what the run is doing, in words and plots at the right.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "sim_host/view/frame_maker.h"
#include "sim_host/view/scene_change.h"
#include "sim_host/view/steering.h"
#include "sim_host/viewer/hand_control.h"
#include "sim_host/viewer/overlay.h"
#include "sim_host/viewer/scene_renderer.h"
#include "sim_host/viewer/theme.h"

namespace palpate {

inline constexpr ImGuiWindowFlags kPanelFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                                ImGuiWindowFlags_NoSavedSettings |
                                                ImGuiWindowFlags_NoBringToFrontOnFocus;
inline ImVec4 colour_vector(Colour c) { return {c.r, c.g, c.b, 1}; }

// Broken into lines at the panel's edge.
void wrapped(Colour c, const std::string& text);

struct PanelScene {
  const Model* model;
  const RunTrack* track;
  const ViewFrame* frame;  // null before the first
  bool is_live = false;    // a run goes on
  bool can_steer = false;  // its device is the mouse
  Steering* steering = nullptr;
  HandControl* hand = nullptr;
  const SceneChange* change = nullptr;  // of a run that can go over to other scenes
};

// What a person asks of the camera.
struct CameraWish {
  bool all = false;                  // all is to be seen
  std::optional<StandardView> view;  // from there; otherwise from the side of the contacts
};

// At the right, over the given rectangle of the window.
void side_panel(ImVec2 low, ImVec2 size, const PanelScene& scene, ViewLayers& layers, CameraWish& wish);

void apply_style(float scale);

}  // namespace palpate
