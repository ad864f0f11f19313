// The panels of the viewer: what the run is doing in words and plots at the right, the time below.
#pragma once

#include <imgui.h>

#include <string>

#include "sim_host/view/frame_maker.h"
#include "sim_host/view/player.h"
#include "sim_host/view/steering.h"
#include "sim_host/viewer/overlay.h"
#include "sim_host/viewer/scene_renderer.h"

namespace palpate {

struct PanelScene {
  const Model* model;
  const RunTrack* track;
  const ViewFrame* frame;  // null before the first
  bool is_live = false;    // a run goes on
  bool can_steer = false;  // its device is the mouse
  Steering* steering = nullptr;
};

// At the right, over the given rectangle of the window.
void side_panel(ImVec2 low, ImVec2 size, const PanelScene& scene, ViewLayers& layers, OrbitCamera& camera,
                bool& reset_camera);
// Below: play, scrub, events.
void timeline(ImVec2 low, ImVec2 size, const PanelScene& scene, Player& player);

void apply_style(float scale);

}  // namespace palpate
