// What is written and drawn flat over the scene: title, numbers at arrows, legends, axes, scale bar, the mouse's hand.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "sim_host/view/orbit_camera.h"
#include "sim_host/view/view_scales.h"
#include "sim_host/viewer/scene_renderer.h"

namespace palpate {

struct Fonts {
  ImFont* text = nullptr;
  ImFont* title = nullptr;
};

struct OverlayScene {
  const Model* model;
  const State* state;
  std::string title, line;  // line: under the title
  std::string letter;       // before the title, in its colour; "" for none
  Colour letter_colour{};
  std::string notice;  // "" or what to know of what is shown, in the middle above
  ColourScale colours;
  ForceScale forces;
  ViewLayers layers;
  std::optional<Vec3> hand_m;  // where the mouse pulls, when it does
  std::optional<Vec3> held_m;  // the place of the tool it pulls
};

// Into the rectangle of the screen that the scene fills.
void draw_overlay(ImDrawList* list, ImVec2 low, ImVec2 size, const OrbitCamera& camera, const OverlayScene& scene,
                  const Fonts& fonts);

}  // namespace palpate
