#include "tests/published/sheets/scene_panel.h"

#include <algorithm>
#include <stdexcept>

#include "config/beams/beam_selection.h"
#include "config/scene/schema.h"
#include "rt_core/skeleton/beam_table.h"
#include "sim_host/view/anchors.h"
#include "sim_host/view/picture.h"
#include "sim_host/view/view_scales.h"

namespace palpate::papers {

namespace {

std::vector<std::int32_t> touching(const State& state) {
  std::vector<std::int32_t> slots;
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot)
    if (state.region[slot].id != 0 && state.region[slot].lost_ticks == 0) slots.push_back(slot);
  return slots;
}

Moment play(const SceneModel& scene, std::vector<TimedPose> poses, double hand_N_per_m, double time_s) {
  std::erase_if(poses, [time_s](const TimedPose& pose) { return pose.time_s > time_s; });
  if (poses.empty()) throw std::runtime_error("no pose before the moment to draw");
  const StatePtr state = make_state(scene.model());
  Moment moment;
  const std::size_t last = poses.size() - 1;
  std::size_t row = 0;
  press(scene.model(), poses, {hand_N_per_m}, *state, nullptr,
        [&](const PressRow&, const State& now, const Scratch& scratch) {
          if (row++ < last) return;
          moment.state = copy_of(now);
          for (std::int32_t i = 0; i < scratch.contact_count; ++i) moment.contact.push_back(scratch.contact[i]);
        });
  return moment;
}

}  // namespace

SceneModel shipped(const std::string& name, const std::vector<std::string>& overlays,
                   const std::vector<std::string>& settings) {
  const std::string folder = std::string(PALPATE_SOURCE_DIR) + "/config/scenes/";
  SceneOverlays with;
  for (const std::string& overlay : overlays) with.file.push_back(folder + overlay);
  with.setting = settings;
  return SceneModel(folder + name + ".toml", with);
}

Moment moment_of(const SceneModel& scene, double time_s) {
  const PathDesc& path = scene.scene()->path;
  return play(scene, scripted_poses(path, scene.model().params.period_s), path.hand_stiffness_N_per_m, time_s);
}
Moment moment_of(const SceneModel& scene, const std::vector<TimedPose>& poses, double time_s) {
  return play(scene, poses, 0, time_s);
}
Moment at_rest(const SceneModel& scene) { return moment_of(scene, 0); }

std::vector<Line3> straight_beams(const Model& model, const State& state, bool mutual) {
  const AnchorField field = anchors_of(model, state);
  const std::vector<std::int32_t> slots = touching(state);
  std::vector<Line3> beams;
  for (const std::int32_t slot : slots) {
    const Vec3 from = state.region[slot].centre_w;
    for (std::size_t a = 0; a < model.anchor.size(); ++a)
      beams.push_back({from, model.anchor[a].position_m + field.anchor[a].displacement_w});
    for (const std::int32_t other : slots)
      if (mutual && other > slot) beams.push_back({from, state.region[other].centre_w});
  }
  return beams;
}

std::vector<Line3> circular_beams(const SceneModel& scene, const State& state) {
  const Model& model = scene.model();
  const std::vector<std::int32_t> slots = touching(state);
  if (slots.empty()) throw std::runtime_error("nothing touches where circular beams are to be drawn");
  const Vec3 at = state.region[slots[0]].centre_w;
  std::int32_t vertex = 0;
  for (std::int32_t v = 1; v < static_cast<std::int32_t>(model.vertex_m.size()); ++v)
    if (squared_norm(model.vertex_m[static_cast<std::size_t>(v)] - at) <
        squared_norm(model.vertex_m[static_cast<std::size_t>(vertex)] - at))
      vertex = v;
  // As build_beam_table chooses them; a grid of a tenth of the wall that is known.
  const double wall_m = scene.scene()->body.wall_m;
  const DistanceGrid grid(model, wall_m / 8);
  const double width_m = 0.25 * wall_m, edge_m = 2e-3;
  const BeamSelector selector(model, grid, {width_m, scene.scene()->skeleton.beam_allowance_m, false}, 0.03 * wall_m,
                              edge_m);
  std::vector<Line3> beams;
  for (const Anchor& anchor : model.anchor) {
    const BeamChoice choice = selector.choose(vertex, anchor.position_m, anchor.normal);
    for (int k = 0; k < choice.count; ++k) {
      Line3 line;
      for (int i = 0; i <= 32; ++i) line.push_back(curve_point(choice.curve[k], i / 32.0, 0.5 * width_m));
      beams.push_back(std::move(line));
    }
  }
  return beams;
}

Canvas scene_panel(const Model& scene, const State& state, const std::vector<Line3>& beams, const PanelView& view) {
  Model model = scene;
  if (!view.tool) model.piece = {};
  constexpr int kFine = 2;  // drawn larger, so that lines and arrows are fine
  PictureOptions options;
  options.width = kFine * kPanelWidth, options.height = kFine * kPanelHeight;
  options.bare = true;
  options.supersampling = 1;
  options.colour_max = view.displacement_max_m;
  std::vector<Vec3> points;
  for (const DrawnForce& force : drawn_forces(state))
    points.push_back(force.tail_w +
                     force_scale(force_sum(state).largest_N, model.params.surface_size_m).m_per_N * force.force_N);
  options.camera = default_camera(model, state, points, double(options.width) / options.height, view.view);
  Canvas large = render_scene(model, state, refined_surface(scene, state, 60'000), options);
  const Projection projection(*options.camera, options.width, options.height);
  for (const Line3& beam : beams) {
    Stroke line;
    for (const Vec3& p : beam) {
      const Vec3 at = projection(p);
      line.push_back({at.x, at.y});
    }
    large.polyline(line, 2.6, colour(0x1b4fa0), 0.85);
  }
  Canvas canvas(kPanelWidth, kPanelHeight, kPaper);
  for (int y = 0; y < kPanelHeight; ++y)
    for (int x = 0; x < kPanelWidth; ++x) {
      Colour sum{};
      for (int k = 0; k < kFine * kFine; ++k) {
        const Colour c = large.pixel(kFine * x + k % kFine, kFine * y + k / kFine);
        sum.r += c.r / (kFine * kFine), sum.g += c.g / (kFine * kFine), sum.b += c.b / (kFine * kFine);
      }
      canvas.set_pixel(x, y, sum);
    }
  return canvas;
}

}  // namespace palpate::papers
