#include "sim_host/viewer/viewer_app.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "rt_core/tool/articulate.h"
#include "rt_core/tool/held_body.h"
#include "sim_host/latency/histogram.h"
#include "sim_host/status_text.h"
#include "sim_host/view/picture.h"
#include "sim_host/view/png_file.h"
#include "sim_host/viewer/panels.h"
#include "sim_host/viewer/view_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace palpate {

namespace {

using Clock = std::chrono::steady_clock;

class Viewer {
 public:
  Viewer(const ViewerRun& run, const ViewerOptions& options)
      : run_(run),
        options_(options),
        window_(options.width, options.height, options.title, options.screenshot.empty()),
        maker_(*run.model, *run.track, copy_of(*run.initial), options.most_triangles),
        renderer_(*run.model, maker_.body(), maker_.at_rest()) {
    player_.live = run.live() && !options.at_s;
    panel_ = options.panel;
  }

  void show() {
    start_camera();
    if (!options_.screenshot.empty()) return screenshot();
    auto before = Clock::now();
    const auto start = before;
    while (!window_.wants_to_close() && !(run_.closes && run_.closes())) {
      const auto now = Clock::now();
      const double elapsed_s = std::chrono::duration<double>(now - before).count();
      before = now;
      add(frame_times_, static_cast<std::int64_t>(1e9 * elapsed_s), ++frames_);
      if (options_.stats) camera_.orbit(3, 0, 1000);  // every picture is a new one
      step(elapsed_s);
      if (options_.stats && std::chrono::duration<double>(now - start).count() > options_.stats_s) break;
    }
    if (options_.stats) print_stats();
  }

 private:
  const RunTrack& track() const { return *run_.track; }
  double first_s() const { return track().time_s(0); }
  double last_s() const {
    const std::size_t size = track().size();
    return size > 0 ? track().time_s(size - 1) : 0;
  }

  // As the still pictures see the strongest tick, or a standard view.
  void start_camera() {
    if (options_.at_s) player_.seek(*options_.at_s, first_s(), last_s());
    if (!options_.at_s && !run_.live()) player_.seek(track().time_s(track().strongest()), first_s(), last_s());
    std::shared_ptr<const ViewFrame> frame;
    if (track().size() > 0) frame = maker_.wait_for(track().index_at(player_.time_s()));
    frame_known_ = frame != nullptr;
    reset_camera(frame ? *frame->state : *run_.initial);
    if (!options_.default_view) camera_.look_from(options_.view);
  }

  void reset_camera(const State& state) {
    const Layout place = layout();
    const double aspect = static_cast<double>(place.scene_size.x / place.scene_size.y);
    Vec3 middle;
    for (const Vec3 v : run_.model->vertex_m) middle += (1.0 / static_cast<double>(run_.model->vertex_m.size())) * v;
    const ForceScale scale = force_scale(track().largest_region_N(), renderer_.size_m());
    std::vector<Vec3> tips;
    for (const DrawnForce& force : drawn_forces(state)) tips.push_back(force.tail_w + scale.m_per_N * force.force_N);
    camera_ = OrbitCamera(default_camera(*run_.model, state, tips, aspect), middle);
    camera_.zoom(-0.7);  // room for the foot
  }

  struct Layout {
    ImVec2 scene_size, panel_at, panel_size, timeline_at, timeline_size;
  };
  Layout layout() const {
    const float unit = window_.fonts().text->FontSize;
    const auto width = static_cast<float>(window_.width()), height = static_cast<float>(window_.height());
    const float panel = panel_ ? std::min(24 * unit, 0.42f * width) : 0, foot = 4.2f * unit;
    return {
        {width - panel, height - foot}, {width - panel, 0}, {panel, height - foot}, {0, height - foot}, {width, foot}};
  }

  void step(double elapsed_s) {
    window_.poll();
    player_.advance(elapsed_s, first_s(), last_s());
    if (track().size() > 0) maker_.want(track().index_at(player_.time_s()));
    const std::shared_ptr<const ViewFrame> frame = maker_.newest();
    // A run that goes on shows where its tool is with its first tick.
    if (frame && !shown_ && !frame_known_) {
      reset_camera(*frame->state);
      if (!options_.default_view) camera_.look_from(options_.view);
    }
    if (frame && frame != shown_) {
      renderer_.show(*frame);
      shown_ = frame;
      ++surfaces_;
      surface_ms_ += frame->made_ms;
    }
    draw();
    window_.present();
    if (wants_picture_) save_picture_beside();
    wants_picture_ = false;
    if (ImGui::IsKeyPressed(GLFW_KEY_P, false)) wants_picture_ = true;  // the next one, drawn in full
  }

  void draw() {
    const Layout place = layout();
    window_.begin_ui();
    GlFramebuffer& scene = window_.scene();
    if (shown_) {
      DisplacementScale colours =
          displacement_scale(std::max(largest_m_ = std::max(largest_m_, shown_->largest_m), 1e-4), false);
      const ForceScale forces = force_scale(track().largest_region_N(), renderer_.size_m());
      draw_scene(colours, forces, place.scene_size);
      ImDrawList* list = ImGui::GetBackgroundDrawList();
      list->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(scene.texture())), {0, 0},
                     place.scene_size, {0, 1}, {1, 0});
      draw_overlay(list, {0, 0}, place.scene_size, camera_, overlay(colours, forces), window_.fonts());
    }
    bool reset = false;
    const PanelScene panels{run_.model, run_.track, shown_.get(), live(), run_.can_steer() && live(), run_.steering};
    if (panel_) side_panel(place.panel_at, place.panel_size, panels, layers_, camera_, reset);
    timeline(place.timeline_at, place.timeline_size, panels, player_);
    if (reset && shown_) reset_camera(*shown_->state);
    mouse(place);
    keys();
    window_.end_ui();
  }

  // Again only when something changed. Where drawing is slow, in software, a picture that moves is drawn at half the
  // size without anti-aliasing, and once more in full when it stands still.
  void draw_scene(const DisplacementScale& colours, const ForceScale& forces, ImVec2 size) {
    constexpr double kSlow_ms = 30;
    const Drawn now{camera_.camera().eye_m, camera_.target_m(), size.x, size.y, layers_, shown_.get(), colours.top_m};
    const bool moved = !(now == drawn_);
    if (!moved && drawn_fully_) return;
    const bool full = !moved || !options_.screenshot.empty() || !slow_ || wants_picture_;
    const int share = full ? 1 : 2;
    const auto start = Clock::now();
    window_.scene().resize(static_cast<int>(size.x) / share, static_cast<int>(size.y) / share, 1, GL_RGBA8);
    ViewLayers layers = layers_;
    // The outline is drawn anew for each view: not for one that is gone with the next picture.
    if (!full && !(now.eye_m == drawn_.eye_m)) layers.rest_outline = false;
    renderer_.draw(*shown_, camera_, layers, colours, forces, window_.scene(), full ? 4 : 1);
    glFinish();
    const double took_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    if (full && moved) slow_ = took_ms > kSlow_ms;
    drawn_ = now;
    drawn_fully_ = full;
    add(scene_times_, static_cast<std::int64_t>(1e6 * took_ms), ++scenes_);
  }

  bool live() const { return run_.live(); }

  OverlayScene overlay(const DisplacementScale& colours, const ForceScale& forces) const {
    const TrackTick tick = track().at(shown_->index);
    OverlayScene scene;
    scene.model = run_.model;
    scene.state = shown_->state.get();
    scene.title = options_.title;
    scene.line = fmt::format("{:.3f} s    |F| = {:.2f} N    felt {:.2f} N    depth {:.2f} mm    {} contact region{}",
                             track().time_s(shown_->index), norm(tick.contact_N), norm(tick.device_N),
                             1e3 * std::max(0.0, tick.depth_m), tick.regions, tick.regions == 1 ? "" : "s");
    if (run_.notice) scene.notice = run_.notice();
    scene.colours = colours;
    scene.forces = forces;
    scene.layers = layers_;
    if (grabbed_) {
      scene.hand_m = transform(hand_, *grabbed_);
      scene.held_m = transform(shown_->state->tool_w, *grabbed_);
    }
    return scene;
  }

  // --- The mouse: turns the view, or is the device -----------------------------------------------------------------

  Projection projection(const Layout& place) const {
    return {camera_.camera(), static_cast<int>(place.scene_size.x), static_cast<int>(place.scene_size.y)};
  }

  // The nearest place of the tool under the mouse, in the tool's frame.
  std::optional<Vec3> tool_under(ImVec2 mouse, const Projection& view) const {
    const Vec3 ray = view.ray(static_cast<double>(mouse.x), static_cast<double>(mouse.y));
    std::optional<Vec3> hit;
    double nearest = 1e300;
    for (std::size_t i = 0; i < run_.model->piece.size(); ++i) {
      const Pose carrier = carrier_w(*run_.model, *shown_->state, static_cast<std::int32_t>(i));
      const double at = ray_hit(piece_mesh(*run_.model, run_.model->piece[i], carrier), view.eye(), ray);
      if (at < 0 || at > nearest) continue;
      nearest = at;
      hit = inverse_transform(shown_->state->tool_w, view.eye() + at * ray);
    }
    return hit;
  }

  // A thin tool is caught beside it, too.
  std::optional<Vec3> tool_near(ImVec2 mouse, const Projection& view) const {
    std::optional<Vec3> hit = tool_under(mouse, view);
    for (int k = 0; k < 8 && !hit; ++k) {
      const double angle = 0.25 * kPi * k, reach = 0.5 * static_cast<double>(window_.fonts().text->FontSize);
      hit = tool_under({mouse.x + static_cast<float>(reach * std::cos(angle)),
                        mouse.y + static_cast<float>(reach * std::sin(angle))},
                       view);
    }
    return hit;
  }

  void mouse(const Layout& place) {
    const ImGuiIO& io = ImGui::GetIO();
    const int height = static_cast<int>(place.scene_size.y);
    const bool over = !io.WantCaptureMouse && io.MousePos.x < place.scene_size.x && io.MousePos.y < place.scene_size.y;
    const Projection view = projection(place);
    if (over && ImGui::IsMouseClicked(0) && shown_) {
      turning_ = true;
      if (run_.can_steer() && live() && player_.live) grab(tool_near(io.MousePos, view));
    }
    if (over && (ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2))) shifting_ = true;
    if (!ImGui::IsMouseDown(0)) turning_ = false, grabbed_.reset();
    if (!ImGui::IsMouseDown(1) && !ImGui::IsMouseDown(2)) shifting_ = false;
    const auto dx = static_cast<double>(io.MouseDelta.x), dy = static_cast<double>(io.MouseDelta.y);
    if (grabbed_) return drag(view, io);
    if (turning_) camera_.orbit(dx, dy, height);
    if (shifting_) camera_.pan(dx, dy, height);
    if (over && io.MouseWheel != 0) camera_.zoom(static_cast<double>(io.MouseWheel));
  }

  void grab(const std::optional<Vec3>& place_tool) {
    if (!place_tool) return;
    grabbed_ = place_tool;
    hand_ = shown_->state->device_w;
    plane_w_ = transform(hand_, *place_tool);
    turning_ = false;
  }

  // The grabbed place follows the mouse in the plane that faces the camera; the handle keeps its rotation.
  void drag(const Projection& view, const ImGuiIO& io) {
    plane_w_ += 0.02 * renderer_.size_m() * static_cast<double>(io.MouseWheel) * view.forward();
    const Vec3 at = drag_point(view, plane_w_, static_cast<double>(io.MousePos.x), static_cast<double>(io.MousePos.y));
    hand_.position_m = at - rotate(hand_.orientation, *grabbed_);
    run_.steering->pull(handle_for(*run_.model, hand_));
  }

  void keys() {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsKeyPressed(GLFW_KEY_TAB, false)) panel_ = !panel_;
    if (ImGui::IsKeyPressed(GLFW_KEY_SPACE, false) && !player_.live) player_.toggle(first_s(), last_s());
    if (ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false) || ImGui::IsKeyPressed(GLFW_KEY_Q, false)) window_.close();
    const double ticks = io.KeyCtrl ? 100 : 1;
    for (const auto& [key, way] : {std::pair{GLFW_KEY_LEFT, -1.0}, {GLFW_KEY_RIGHT, 1.0}}) {
      if (!ImGui::IsKeyPressed(key)) continue;
      player_.live = player_.playing = false;
      player_.seek(player_.time_s() + way * ticks * track().period_s(), first_s(), last_s());
    }
    constexpr std::pair<int, StandardView> kViews[] = {
        {GLFW_KEY_1, StandardView::kOblique}, {GLFW_KEY_2, StandardView::kFront}, {GLFW_KEY_3, StandardView::kRight},
        {GLFW_KEY_4, StandardView::kTop},     {GLFW_KEY_5, StandardView::kLeft},  {GLFW_KEY_6, StandardView::kBack}};
    for (const auto& [key, view] : kViews)
      if (ImGui::IsKeyPressed(key, false)) camera_.look_from(view);
    if (run_.can_steer() && is_articulated(*run_.model)) fingers(static_cast<double>(io.DeltaTime));
  }

  // Held keys close and open at a quarter of the way in a second.
  void fingers(double elapsed_s) {
    constexpr double kRate_per_s = 0.25;
    const double way = (ImGui::IsKeyDown(GLFW_KEY_C) ? 1 : 0) - (ImGui::IsKeyDown(GLFW_KEY_O) ? 1 : 0);
    if (way == 0) return;
    const double now = run_.steering->closing() < 0 ? 0 : static_cast<double>(run_.steering->closing());
    run_.steering->close_to(std::clamp(now + way * kRate_per_s * elapsed_s, 0.0, 1.0));
  }

  // Into the current folder, over nothing that is there.
  void save_picture_beside() const {
    std::string name;
    for (int i = 1; name.empty() || std::filesystem::exists(name); ++i)
      name = fmt::format("{}-{}.png", run_.model->name, i);
    write_png(name, window_.width(), window_.height(), window_.picture().pixels());
    fmt::print("wrote   {}\n", name);
  }

  // --- Without a person ------------------------------------------------------------------------------------------

  void screenshot() {
    shown_ = maker_.newest();
    if (!shown_) throw std::runtime_error("there is no tick to show");
    // The colours of the whole run are not known; those of the tick stand on their own.
    renderer_.show(*shown_);
    for (int i = 0; i < 4; ++i) {  // panels take their places in the first ones
      window_.poll();
      draw();
    }
    const std::vector<std::uint8_t> pixels = window_.picture().pixels();
    write_png(options_.screenshot, window_.width(), window_.height(), pixels);
    fmt::print("wrote   {} (tick {}, {:.3f} s)\n", options_.screenshot, track().at(shown_->index).tick,
               track().time_s(shown_->index));
  }

  void print_stats() const {
    const auto ms = [](std::int64_t ns) { return 1e-6 * static_cast<double>(ns); };
    fmt::print("drawn   {} frames of {} x {}, {} triangles: median {:.1f} ms, 99 % {:.1f} ms, longest {:.1f} ms\n",
               frames_, window_.width(), window_.height(), maker_.body().triangle.size(),
               ms(percentile_ns(frame_times_, 0.5)), ms(percentile_ns(frame_times_, 0.99)), ms(frame_times_.max_ns));
    fmt::print("scene   {} drawn: median {:.1f} ms, 99 % {:.1f} ms, longest {:.1f} ms\n", scenes_,
               ms(percentile_ns(scene_times_, 0.5)), ms(percentile_ns(scene_times_, 0.99)), ms(scene_times_.max_ns));
    if (surfaces_ > 0)
      fmt::print("surface {} evaluated, {:.1f} ms each on average\n", surfaces_,
                 surface_ms_ / static_cast<double>(surfaces_));
    fmt::print("memory  {:.0f} MB at most; {}\n", most_memory_MB(), window_.driver());
  }

  const ViewerRun& run_;
  const ViewerOptions& options_;
  ViewWindow window_;
  FrameMaker maker_;
  SceneRenderer renderer_;
  OrbitCamera camera_;
  ViewLayers layers_;
  Player player_;
  std::shared_ptr<const ViewFrame> shown_;
  // What the scene's picture shows.
  struct Drawn {
    Vec3 eye_m, target_m;
    float width = 0, height = 0;
    ViewLayers layers;
    const ViewFrame* frame = nullptr;
    double colour_top_m = 0;
    bool operator==(const Drawn&) const = default;
  };
  Drawn drawn_;
  bool drawn_fully_ = false, slow_ = false;
  Histogram scene_times_;
  std::uint64_t scenes_ = 0;
  double largest_m_ = 0;
  bool panel_ = true, wants_picture_ = false;
  bool frame_known_ = false;  // when the camera was placed
  bool turning_ = false, shifting_ = false;
  std::optional<Vec3> grabbed_;  // of the tool, its frame
  Vec3 plane_w_;                 // the mouse moves it in the plane through here
  Pose hand_;                    // where the handle is pulled
  Histogram frame_times_;
  std::uint64_t frames_ = 0, surfaces_ = 0;
  double surface_ms_ = 0;
};

}  // namespace

void show_run(const ViewerRun& run, const ViewerOptions& options) { Viewer(run, options).show(); }

}  // namespace palpate
