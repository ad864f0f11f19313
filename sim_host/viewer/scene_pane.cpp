#include "sim_host/viewer/scene_pane.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "rt_core/tool/articulate.h"
#include "sim_host/view/picture.h"

namespace palpate {

ScenePane::ScenePane(const ViewerRun& run, std::size_t most_triangles)
    : run_(run),
      maker_(*run.model, *run.track, copy_of(*run.initial), most_triangles,
             ShaderSurface::can(*run.model, most_triangles)),
      renderer_(*run.model, maker_) {}

bool ScenePane::take_frame() {
  const std::shared_ptr<const ViewFrame> frame = maker_.newest();
  if (!frame || frame == shown_) return false;
  const auto start = std::chrono::steady_clock::now();
  const auto largest = renderer_.show(*frame);
  shader_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  shown_ = frame;
  for (std::size_t i = 0; i < largest_.size(); ++i) largest_[i] = std::max(largest_[i], largest[i]);
  ++surfaces_;
  surface_ms_ += frame->made_ms;
  return true;
}

void ScenePane::draw(const PaneView& view, ImVec2 size, bool full) {
  constexpr double kSlow_ms = 30;
  if (!shown_) return;
  const Drawn now{view.camera.camera().eye_m, view.camera.target_m(), size.x, size.y, view.layers, shown_.get(),
                  view.colours.top,           view.forces.m_per_N};
  const bool moved = !(now == drawn_);
  if (!moved && drawn_fully_) return;
  full = full || !moved || !slow_;
  const int share = full ? 1 : 2;
  const auto start = std::chrono::steady_clock::now();
  picture_.resize(static_cast<int>(size.x) / share, static_cast<int>(size.y) / share, 1, GL_RGBA8);
  ViewLayers layers = view.layers;
  // The outline is drawn anew for each view: not for one that is gone with the next picture.
  if (!full && !(now.eye_m == drawn_.eye_m)) layers.rest_outline = false;
  renderer_.draw(*shown_, view.camera, layers, view.colours, view.forces, picture_, full ? 4 : 1, !full);
  glFinish();
  const double took_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (full && moved) slow_ = took_ms > kSlow_ms;
  drawn_ = now;
  drawn_fully_ = full;
  add(times_, static_cast<std::int64_t>(1e6 * took_ms), ++scenes_);
}

OverlayScene ScenePane::overlay(const PaneView& view) const {
  const TrackTick tick = track().at(shown_->index);
  OverlayScene scene;
  scene.model = run_.model;
  scene.state = shown_->state.get();
  scene.line =
      fmt::format("{:.3f} s    {}    felt {:.2f} N    depth {:.2f} mm", track().time_s(shown_->index),
                  force_words(force_sum(*shown_->state)), norm(tick.device_N), 1e3 * std::max(0.0, tick.depth_m));
  if (run_.notice) scene.notice = run_.notice();
  scene.colours = view.colours;
  scene.forces = view.forces;
  scene.layers = view.layers;
  return scene;
}

std::optional<Vec3> ScenePane::tool_under(double x, double y, const Projection& view) const {
  const Vec3 ray = view.ray(x, y);
  std::optional<Vec3> hit;
  double nearest = 1e300;
  for (std::size_t i = 0; i < model().piece.size(); ++i) {
    const Pose carrier = carrier_w(model(), *shown_->state, static_cast<std::int32_t>(i));
    const double at = ray_hit(piece_mesh(model(), model().piece[i], carrier), view.eye(), ray);
    if (at < 0 || at > nearest) continue;
    nearest = at;
    hit = inverse_transform(shown_->state->tool_w, view.eye() + at * ray);
  }
  return hit;
}

std::optional<Vec3> ScenePane::tool_near(ImVec2 mouse, const Projection& view, double reach) const {
  const auto x = static_cast<double>(mouse.x), y = static_cast<double>(mouse.y);
  std::optional<Vec3> hit = tool_under(x, y, view);
  for (int k = 0; k < 8 && !hit; ++k) {
    const double angle = 0.25 * kPi * k;
    hit = tool_under(x + reach * std::cos(angle), y + reach * std::sin(angle), view);
  }
  return hit;
}

void ScenePane::print_stats() {
  const auto ms = [](std::int64_t ns) { return 1e-6 * static_cast<double>(ns); };
  fmt::print("scene   {} drawn, {} triangles, while it moves {}: median {:.1f} ms, 99 % {:.1f} ms, longest {:.1f} ms\n",
             scenes_, maker_.body().triangle.size(), renderer_.fewer_triangles(), ms(percentile_ns(times_, 0.5)),
             ms(percentile_ns(times_, 0.99)), ms(times_.max_ns));
  if (surfaces_ == 0) return;
  fmt::print("surface {} evaluated, {:.1f} ms each on average", surfaces_,
             surface_ms_ / static_cast<double>(surfaces_));
  const auto off = renderer_.from_reference();
  if (!off) return fmt::print("\n");
  fmt::print(" and {:.1f} ms in the vertex shader\n", shader_ms_ / static_cast<double>(surfaces_));
  for (const auto& [what, apart] : {std::pair{"in full", (*off)[0]}, {"moving", (*off)[1]}})
    fmt::print("shader  {}: from the reference at most {:.3f} um, normals {:.3f} degrees, pressure {:.3f} %\n", what,
               1e6 * apart.position_m, apart.normal_rad * 180 / kPi, 100 * apart.pressure);
}

}  // namespace palpate
