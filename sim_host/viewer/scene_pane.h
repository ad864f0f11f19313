// One run in its part of the window: its frames, its renderer and the picture of its scene.
#pragma once

#include "sim_host/latency/histogram.h"
#include "sim_host/viewer/overlay.h"
#include "sim_host/viewer/scene_renderer.h"
#include "sim_host/viewer/viewer_app.h"

namespace palpate {

// How all panes are drawn: of two runs beside one another, too, there is one of each.
struct PaneView {
  const OrbitCamera& camera;
  const ViewLayers& layers;
  const ColourScale& colours;
  const ForceScale& forces;
};

// A step of the wheel moves the plane in which the mouse pulls by this share of the body's extent.
inline constexpr double kPlaneStep = 0.02;

class ScenePane {
 public:
  // A context must be current; `run` must outlive this.
  ScenePane(const ViewerRun& run, std::size_t most_triangles);

  const ViewerRun& run() const { return run_; }
  const Model& model() const { return *run_.model; }
  const RunTrack& track() const { return *run_.track; }
  FrameMaker& maker() { return maker_; }
  const SceneRenderer& renderer() const { return renderer_; }
  // What is shown; null before the first frame.
  const std::shared_ptr<const ViewFrame>& shown() const { return shown_; }
  // Shown so far, m or Pa.
  double largest(SurfaceColour colour) const { return largest_[static_cast<std::size_t>(colour)]; }

  // Takes the newest frame there is; whether it is another one than before.
  bool take_frame();
  // Its scene into a picture of `size`, again only when something changed. Where drawing is slow, in software, one that
  // moves is drawn at half the size without anti-aliasing and with fewer triangles, and once more in full when it
  // stands still; `full`: at once.
  void draw(const PaneView& view, ImVec2 size, bool full);
  GLuint texture() const { return picture_.texture(); }
  // Scene and numbers of the tick shown, but for title and mouse.
  OverlayScene overlay(const PaneView& view) const;
  // The nearest place of the tool under the mouse, in the tool's frame; a thin one is caught within `reach` pixels,
  // too.
  std::optional<Vec3> tool_near(ImVec2 mouse, const Projection& view, double reach) const;

  void print_stats();

 private:
  std::optional<Vec3> tool_under(double x, double y, const Projection& view) const;

  const ViewerRun& run_;
  FrameMaker maker_;
  SceneRenderer renderer_;
  GlFramebuffer picture_;
  std::shared_ptr<const ViewFrame> shown_;
  std::array<double, 3> largest_{};
  // What the picture shows.
  struct Drawn {
    Vec3 eye_m, target_m;
    float width = 0, height = 0;
    ViewLayers layers;
    const ViewFrame* frame = nullptr;
    double colour_top = 0, m_per_N = 0;
    bool operator==(const Drawn&) const = default;
  };
  Drawn drawn_;
  bool drawn_fully_ = false, slow_ = false;
  Histogram times_;
  std::uint64_t scenes_ = 0, surfaces_ = 0;
  double surface_ms_ = 0, shader_ms_ = 0;
};

}  // namespace palpate
