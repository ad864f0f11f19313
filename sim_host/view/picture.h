// A picture of the deformed body with the tool, for documents and reports: colour by displacement, contact pressure or
// anchor stress, translucent tool, contact forces as arrows, the rest shape as a dashed outline, anchors as dots.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "rt_core/model.h"
#include "rt_core/state.h"
#include "sim_host/view/deformed_surface.h"
#include "sim_host/view/orbit_camera.h"
#include "sim_host/view/view_scales.h"

namespace palpate {

// Scenes stand on the plane y = 0 (config/body/procedural.h).
inline constexpr Vec3 kWorldUp{0, 1, 0};

struct PictureOptions {
  int width = 1200, height = 900;
  int supersampling = 2;             // samples per pixel and axis, 1..4
  std::optional<Camera> camera;      // otherwise `default_camera`
  std::optional<StandardView> view;  // of default_camera
  std::string title;                 // otherwise the scene's name
  SurfaceColour colour = SurfaceColour::kDisplacement;
  double colour_max = 0;   // top of the colour scale, m or Pa; 0: the largest value, rounded up
  double force_max_N = 0;  // force of the longest arrow; 0: the largest region's
  bool bare = false;       // no words, scales or background: for a panel that has its own
};

// Sees the body, `points_w` and the tool (of a long one the end near the body), slightly from above, from the side on
// which the contacts are, or from `view`, and leaves room for title, legend and scales. `aspect`: width over height.
Camera default_camera(const Model& model, const State& state, std::span<const Vec3> points_w, double aspect,
                      std::optional<StandardView> view = {});
Canvas render_scene(const Model& model, const State& state, const DeformedSurface& surface,
                    const PictureOptions& options = {});
// Writes render_scene of the scene's own shape models as PNG.
void save_picture(const std::string& path, const Model& model, const State& state, const PictureOptions& options = {});

// Colour map of what the body shows, t in 0..1: light sand to dark violet, lightness falling evenly.
Colour map_colour(double t);
// Of a body whose surface has no such value.
inline constexpr Colour kNoValue = colour(0xd9dde2);
// Surface of a tool piece in the world; `carrier_w` as rt_core/tool/articulate.h has it.
RenderMesh piece_mesh(const Model& model, const ToolPiece& piece, const Pose& carrier_w);
// The same for a part of the hand, as people draw it.
RenderMesh hand_render_mesh(const ToolPiece& piece, const Pose& carrier_w, bool left);

}  // namespace palpate
