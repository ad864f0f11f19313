#include "sim_host/viewer/viewer_app.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "rt_core/tool/held_body.h"
#include "sim_host/latency/histogram.h"
#include "sim_host/view/picture.h"
#include "sim_host/view/png_file.h"
#include "sim_host/viewer/comparison_panel.h"
#include "sim_host/viewer/keyboard.h"
#include "sim_host/viewer/panels.h"
#include "sim_host/viewer/plots.h"
#include "sim_host/viewer/scene_list.h"
#include "sim_host/viewer/scripted_user.h"
#include "sim_host/viewer/timeline.h"
#include "sim_host/viewer/view_window.h"

namespace palpate {

namespace {

using Clock = std::chrono::steady_clock;

class Viewer {
 public:
  // `comparison`: of two runs; null for one.
  Viewer(std::span<const ViewerRun> runs, const Comparison* comparison, const ViewerOptions& options)
      : options_(options),
        runs_(runs.begin(), runs.end()),
        comparison_(comparison),
        window_(options.width, options.height, runs.front().title, options.screenshot.empty()),
        user_(options.script) {
    for (const ViewerRun& run : runs_) panes_.push_back(std::make_unique<ScenePane>(run, options.most_triangles));
    if (const ViewerRun& run = runs_.front(); run.change != nullptr) list_.emplace(run.scene->choice, run.also);
    player_.live = first().run().live() && !options.at_s;
    panel_ = options.panel;
    layers_.colour = options.colour;
  }

  void show() {
    start_camera();
    if (!options_.screenshot.empty()) return screenshot();
    auto before = Clock::now();
    const auto start = before;
    const ViewerRun& run = first().run();
    while (!window_.wants_to_close() && !(run.closes && run.closes())) {
      const auto now = Clock::now();
      const double elapsed_s = std::chrono::duration<double>(now - before).count();
      before = now;
      add(frame_times_, static_cast<std::int64_t>(1e9 * elapsed_s), ++frames_);
      if (options_.stats) camera_.orbit(3, 0, 1000);  // every picture is a new one
      step(elapsed_s);
      if (options_.stats && std::chrono::duration<double>(now - start).count() > options_.stats_s) break;
      if (!options_.script.empty() && user_.is_done()) break;
    }
    if (options_.stats) print_stats();
  }

 private:
  const ScenePane& first() const { return *panes_.front(); }
  const RunTrack& track() const { return first().track(); }
  double first_s() const { return comparison_ != nullptr ? comparison_->first_s() : track().time_s(0); }
  double last_s() const {
    if (comparison_ != nullptr) return comparison_->last_s();
    const std::size_t size = track().size();
    return size > 0 ? track().time_s(size - 1) : 0;
  }
  double zero_s(std::size_t run) const { return comparison_ != nullptr ? comparison_->zero_s(run) : 0; }
  // The tick of a run that is to be seen.
  std::size_t wanted(std::size_t run) const { return panes_[run]->track().index_at(player_.time_s() + zero_s(run)); }

  // As the still pictures see the strongest tick, or a standard view.
  void start_camera() {
    const ViewerRun& run = first().run();
    if (options_.at_s) player_.seek(*options_.at_s, first_s(), last_s());
    const bool both = comparison_ != nullptr && comparison_->difference().ticks > 0;
    if (!options_.at_s && !run.live())
      player_.seek(both ? comparison_->difference().strongest_at_s : track().time_s(track().strongest()) - zero_s(0),
                   first_s(), last_s());
    std::shared_ptr<const ViewFrame> frame;
    for (std::size_t i = panes_.size(); i-- > 0 && track().size() > 0;) frame = panes_[i]->maker().wait_for(wanted(i));
    frame_known_ = frame != nullptr;
    place_camera(frame ? *frame->state : *run.initial);
  }

  void place_camera(const State& state) {
    reset_camera(state, options_.default_view ? std::nullopt : std::optional(options_.view));
  }

  // From the side of the contacts, or from `view`, to see all.
  void reset_camera(const State& state, std::optional<StandardView> view = {}) {
    const ImVec2 size = layout().scene_size;
    const Model& model = first().model();
    Vec3 middle;
    for (const Vec3 v : model.vertex_m) middle += (1.0 / static_cast<double>(model.vertex_m.size())) * v;
    std::vector<Vec3> points;
    for (const DrawnForce& force : drawn_forces(state))
      points.push_back(force.tail_w + arrows().m_per_N * force.force_N);
    for (std::size_t i = 1; i < panes_.size(); ++i)  // the others' bodies are to be seen, too
      points.insert(points.end(), panes_[i]->model().vertex_m.begin(), panes_[i]->model().vertex_m.end());
    camera_ = OrbitCamera(default_camera(model, state, points, static_cast<double>(size.x / size.y), view), middle);
  }

  // A newton has one length, of all runs shown.
  ForceScale arrows() const {
    double largest_N = 0, size_m = 0;
    for (const auto& pane : panes_) {
      largest_N = std::max(largest_N, pane->track().largest_region_N());
      size_m = std::max(size_m, pane->renderer().size_m());
    }
    return force_scale(largest_N, size_m);
  }

  // The scenes stand beside one another from the left upper corner on.
  struct Layout {
    ImVec2 scene_size, panel_at, panel_size, timeline_at, timeline_size;
  };
  Layout layout() const {
    const float unit = window_.fonts().text->FontSize;
    const auto width = static_cast<float>(window_.width()), height = static_cast<float>(window_.height());
    const float foot = 4.2f * unit;
    Layout place;
    place.timeline_at = {0, height - foot};
    place.timeline_size = {width, foot};
    if (panes_.size() > 1) {
      const float below = panel_ ? std::min(15 * unit, 0.34f * height) : 0;
      place.scene_size = {width / static_cast<float>(panes_.size()), height - foot - below};
      place.panel_at = {0, place.scene_size.y};
      place.panel_size = {width, below};
    } else {
      const float beside = panel_ ? std::min(24 * unit, 0.42f * width) : 0;
      place.scene_size = {width - beside, height - foot};
      place.panel_at = {width - beside, 0};
      place.panel_size = {beside, height - foot};
    }
    return place;
  }

  void step(double elapsed_s) {
    window_.poll();
    follow_scene();
    player_.advance(elapsed_s, first_s(), last_s());
    for (std::size_t i = 0; i < panes_.size(); ++i)
      if (panes_[i]->track().size() > 0) panes_[i]->maker().want(wanted(i));
    const bool fresh = !first().shown();
    for (const auto& pane : panes_) pane->take_frame();
    // A run that goes on shows where its tool is with its first tick.
    if (fresh && first().shown() && !frame_known_) place_camera(*first().shown()->state);
    draw(elapsed_s);
    window_.present();
    if (wants_picture_ && first().shown()) save_picture(picture_file_.empty() ? free_name() : picture_file_);
    if (!picture_file_.empty()) user_.picture_taken();
    wants_picture_ = key_pressed(GLFW_KEY_P, false);  // the next one, drawn in full
    picture_file_.clear();
    if (user_.picture() && stands_still()) {
      wants_picture_ = true;
      picture_file_ = *user_.picture();
    }
  }

  // The run went over to another scene: it is shown from its first tick on, as a run that begins.
  void follow_scene() {
    ViewerRun& run = runs_.front();
    if (!run.newest) return;
    std::shared_ptr<const LiveScene> newest = run.newest();
    if (newest == run.scene) return;
    panes_.front().reset();  // which looks at what goes
    run.show(std::move(newest));
    panes_.front() = std::make_unique<ScenePane>(run, options_.most_triangles);
    frame_known_ = false;
    grabbed_.reset();
    player_.live = run.live();
  }

  bool stands_still() const {
    return player_.live || std::ranges::all_of(panes_, [&](const auto& pane) {
             const auto i = static_cast<std::size_t>(&pane - panes_.data());
             return pane->shown() && pane->shown()->index == wanted(i);
           });
  }

  void draw(double elapsed_s) {
    const Layout place = layout();
    window_.begin_ui([&](ImGuiIO& io) { act(io, place, elapsed_s); });
    if (std::ranges::all_of(panes_, [](const auto& pane) { return pane->shown() != nullptr; })) {
      const SurfaceColour shown = layers_.colour;
      double largest = shown == SurfaceColour::kDisplacement ? 1e-4 : 0;
      for (const auto& pane : panes_) largest = std::max(largest, pane->largest(shown));
      const ColourScale colours = colour_scale(shown, largest, false);
      const ForceScale forces = arrows();
      for (std::size_t i = 0; i < panes_.size(); ++i)
        draw_pane(i, {camera_, layers_, colours, forces}, place.scene_size);
    }
    CameraWish wish = std::exchange(wish_, {});
    const ScenePane& pane = first();
    const ViewerRun& run = pane.run();
    const PanelScene panel{&pane.model(), &pane.track(), pane.shown().get(), live(),
                           run_steers(),  run.steering,  &hand_control_,     run.change};
    if (panel_ && comparison_ != nullptr)
      comparison_panel(place.panel_at, place.panel_size, *comparison_, player_.time_s());
    else if (panel_)
      side_panel(place.panel_at, place.panel_size, panel, layers_, wish);
    std::vector<TimelineRun> runs;
    for (std::size_t i = 0; i < panes_.size(); ++i) runs.push_back({&panes_[i]->track(), zero_s(i)});
    timeline(place.timeline_at, place.timeline_size, runs, {first_s(), last_s(), live()}, player_);
    if (list_ && live()) draw_list(place);
    mouse(place);
    keys(wish);
    if (wish.all && pane.shown()) reset_camera(*pane.shown()->state, wish.view);
    window_.end_ui();
  }

  // Below the title, at most as high as what it covers.
  void draw_list(const Layout& place) {
    const float unit = window_.fonts().text->FontSize;
    const ImVec2 low{1.4f * unit, 5.2f * unit};
    const ImVec2 size{std::min(30 * unit, place.scene_size.x - 2 * low.x),
                      std::min(46 * unit, place.scene_size.y - low.y - 1.4f * unit)};
    list_->draw(low, size, *first().run().change);
  }

  void draw_pane(std::size_t i, const PaneView& view, ImVec2 size) {
    ScenePane& pane = *panes_[i];
    pane.draw(view, size, !options_.screenshot.empty() || wants_picture_);
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const ImVec2 low{static_cast<float>(i) * size.x, 0}, high{low.x + size.x, size.y};
    list->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(pane.texture())), low, high, {0, 1},
                   {1, 0});
    OverlayScene scene = pane.overlay(view);
    scene.title = pane.run().title;
    if (comparison_ != nullptr) {
      scene.letter = kRunLetter[i];
      scene.letter_colour = kRunColour[i];
      if (!comparison_->is_there(i, player_.time_s())) scene.notice = "this run has no such time";
    }
    if (grabbed_ && i == 0) {
      scene.hand_m = transform(hand_, *grabbed_);
      scene.held_m = transform(pane.shown()->state->tool_w, *grabbed_);
    }
    list->PushClipRect(low, high, true);
    draw_overlay(list, low, size, camera_, scene, window_.fonts());
    list->PopClipRect();
    if (i > 0) list->AddLine(low, {low.x, high.y}, packed(theme::kLine), 2);
  }

  bool live() const { return first().run().live(); }
  bool run_steers() const { return first().run().can_steer() && live(); }

  // --- The mouse: turns the view, or is the device -----------------------------------------------------------------

  Projection projection(const Layout& place) const {
    return {camera_.camera(), static_cast<int>(place.scene_size.x), static_cast<int>(place.scene_size.y)};
  }

  void act(ImGuiIO& io, const Layout& place, double elapsed_s) {
    if (options_.script.empty()) return;
    user_.act(io,
              {first(), projection(place), place.scene_size, camera_, layers_, wish_, player_, first_s(), last_s(),
               grabbed_, hand_, plane_w_},
              elapsed_s);
  }

  void mouse(const Layout& place) {
    const ImGuiIO& io = ImGui::GetIO();
    const int height = static_cast<int>(place.scene_size.y);
    const float right = static_cast<float>(panes_.size()) * place.scene_size.x;
    const bool over = !io.WantCaptureMouse && io.MousePos.x < right && io.MousePos.y < place.scene_size.y;
    const Projection view = projection(place);
    if (over && ImGui::IsMouseClicked(0) && first().shown()) {
      turning_ = true;
      const double reach = 0.5 * static_cast<double>(window_.fonts().text->FontSize);
      if (run_steers() && player_.live) grab(first().tool_near(io.MousePos, view, reach));
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
    grabbed_from_ = camera_.camera().eye_m;
    hand_ = first().shown()->state->device_w;
    plane_w_ = transform(hand_, *place_tool);
    turning_ = false;
  }

  // The grabbed place follows the mouse in the plane that faces the camera; the handle keeps its rotation. A view that
  // changes under it lets it go, where it was pulled last: its place on the screen is another one then.
  void drag(const Projection& view, const ImGuiIO& io) {
    if (!(view.eye() == grabbed_from_)) return grabbed_.reset();
    plane_w_ += kPlaneStep * first().renderer().size_m() * static_cast<double>(io.MouseWheel) * view.forward();
    const Vec3 at = drag_point(view, plane_w_, static_cast<double>(io.MousePos.x), static_cast<double>(io.MousePos.y));
    hand_.position_m = at - rotate(hand_.orientation, *grabbed_);
    first().run().steering->pull(handle_for(first().model(), hand_));
  }

  void keys(CameraWish& wish) {
    const ImGuiIO& io = ImGui::GetIO();
    if (key_pressed(GLFW_KEY_TAB, false)) panel_ = !panel_;
    if (key_pressed(GLFW_KEY_SPACE, false) && !player_.live) player_.toggle(first_s(), last_s());
    if (key_pressed(GLFW_KEY_ESCAPE, false) || key_pressed(GLFW_KEY_Q, false)) window_.close();
    const double ticks = io.KeyCtrl ? 100 : 1;
    for (const auto& [key, way] : {std::pair{GLFW_KEY_LEFT, -1.0}, {GLFW_KEY_RIGHT, 1.0}}) {
      if (!key_pressed(key)) continue;
      player_.live = player_.playing = false;
      player_.seek(player_.time_s() + way * ticks * track().period_s(), first_s(), last_s());
    }
    constexpr std::pair<int, StandardView> kViews[] = {
        {GLFW_KEY_1, StandardView::kOblique}, {GLFW_KEY_2, StandardView::kFront}, {GLFW_KEY_3, StandardView::kRight},
        {GLFW_KEY_4, StandardView::kTop},     {GLFW_KEY_5, StandardView::kLeft},  {GLFW_KEY_6, StandardView::kBack}};
    for (const auto& [key, view] : kViews)
      if (key_pressed(key, false)) wish = {true, view};
    if (list_ && key_pressed(GLFW_KEY_L, false)) list_->toggle();
    if (key_pressed(GLFW_KEY_K, false))  // the next one
      layers_.colour = static_cast<SurfaceColour>((static_cast<int>(layers_.colour) + 1) % kSurfaceColours);
    if (run_steers() && first().shown())
      hand_control_.keys(first().model(), *first().shown()->state, *first().run().steering,
                         static_cast<double>(io.DeltaTime));
  }

  // In the current folder, of nothing that is there.
  std::string free_name() const {
    std::string name;
    for (int i = 1; name.empty() || std::filesystem::exists(name); ++i)
      name = fmt::format("{}-{}.png", first().model().name, i);
    return name;
  }

  void save_picture(const std::string& file) const {
    write_png(file, window_.width(), window_.height(), window_.picture().pixels());
    fmt::print("wrote   {} (tick {}, {:.3f} s)\n", file, track().at(first().shown()->index).tick,
               track().time_s(first().shown()->index));
  }

  // --- Without a person ------------------------------------------------------------------------------------------

  void screenshot() {
    // The colours of the whole run are not known; those of the tick stand on their own.
    for (const auto& pane : panes_)
      if (!pane->take_frame()) throw std::runtime_error("there is no tick to show");
    for (int i = 0; i < 7; ++i) {  // panels take their places in the first ones
      window_.poll();
      draw(0);
    }
    save_picture(options_.screenshot);
  }

  void print_stats() {
    const auto ms = [](std::int64_t ns) { return 1e-6 * static_cast<double>(ns); };
    fmt::print("drawn   {} frames of {} x {}: median {:.1f} ms, 99 % {:.1f} ms, longest {:.1f} ms\n", frames_,
               window_.width(), window_.height(), ms(percentile_ns(frame_times_, 0.5)),
               ms(percentile_ns(frame_times_, 0.99)), ms(frame_times_.max_ns));
    for (const auto& pane : panes_) pane->print_stats();
    fmt::print("memory  {:.0f} MB at most; {}\n", most_memory_MB(), window_.driver());
  }

  const ViewerOptions& options_;
  std::vector<ViewerRun> runs_;
  const Comparison* comparison_;
  ViewWindow window_;
  ScriptedUser user_;
  HandControl hand_control_;
  std::optional<SceneList> list_;  // of a run that can go over to other scenes
  std::vector<std::unique_ptr<ScenePane>> panes_;
  OrbitCamera camera_;
  ViewLayers layers_;
  Player player_;
  bool panel_ = true, wants_picture_ = false;
  CameraWish wish_;
  std::string picture_file_;  // of the picture that is wanted; "": a free name
  bool frame_known_ = false;  // when the camera was placed
  bool turning_ = false, shifting_ = false;
  std::optional<Vec3> grabbed_;  // of the tool, its frame
  Vec3 grabbed_from_;            // the eye then
  Vec3 plane_w_;                 // the mouse moves it in the plane through here
  Pose hand_;                    // where the handle is pulled
  Histogram frame_times_;
  std::uint64_t frames_ = 0;
};

}  // namespace

void show_run(const ViewerRun& run, const ViewerOptions& options) { Viewer({&run, 1}, nullptr, options).show(); }

void show_comparison(const std::array<ViewerRun, Comparison::kRuns>& runs, const Comparison& comparison,
                     const ViewerOptions& options) {
  Viewer(runs, &comparison, options).show();
}

}  // namespace palpate
