#include <algorithm>

#include "rt_core/contact/regions.h"
#include "sim_host/view/anchors.h"
#include "tests/published/sheets/papers.h"
#include "tests/published/sheets/plot_panel.h"
#include "tests/published/sheets/scene_panel.h"

namespace palpate::papers {

namespace {

constexpr double kHeld_s = 3.4;  // closed since 2.7 s, open from 3.5 s on
constexpr const char* kFingers[] = {"2", "3", "5"};

// How far one anchor has moved after each region, in the order in which they were formed.
Canvas displaced_anchors(const SceneModel& scene, const State& state) {
  const AnchorField field = anchors_of(scene.model(), state);
  std::int32_t order[kMaxRegions];
  const std::int32_t regions = contact_order(state, order);
  std::vector<PlotCurve> curves;
  for (std::int32_t a = 4; a < std::min(field.count, 8); ++a) {
    PlotCurve curve{"anchor " + std::to_string(a + 1), {0}, {0}};
    Vec3 moved;
    for (std::int32_t i = 0; i < regions; ++i) {
      moved += field.by_region_w[order[i]][a];
      curve.x.push_back(i + 1), curve.y.push_back(1e3 * norm(moved));
    }
    curves.push_back(std::move(curve));
  }
  return plot_panel(curves, "contact regions so far", "moved by (mm)");
}

Canvas stresses(const std::string& folder) {
  std::vector<PlotCurve> series;
  for (const char* fingers : kFingers) {
    const Table table(folder + "grasp_cylinder_" + fingers + ".stress.csv");
    const std::vector<double>& time = table["time_s"];
    const auto held = static_cast<std::size_t>(std::ranges::lower_bound(time, 3.0 - 1e-9) - time.begin());
    PlotCurve bars{std::string(fingers) + " fingers", {}, {}};
    for (int a = 1; a <= 8; ++a)
      bars.x.push_back(a), bars.y.push_back(1e-3 * table["anchor" + std::to_string(a) + "_Pa"][held]);
    series.push_back(std::move(bars));
  }
  return plot_panel(series, "anchor", "stress (kPa)", PlotKind::kBars);
}

Canvas stress_history(const std::string& file) {
  const Table table(file);
  std::vector<PlotCurve> curves;
  for (int a = 1; a <= 8; ++a) {
    const std::string number = std::to_string(a);
    PlotCurve curve{number, {}, {}};
    for (std::size_t i = 0; i < table["time_s"].size() && table["time_s"][i] < kHeld_s; ++i)
      curve.x.push_back(table["time_s"][i]), curve.y.push_back(1e-3 * table["anchor" + number + "_Pa"][i]);
    curves.push_back(std::move(curve));
  }
  return plot_panel(curves, "time (s)", "stress at anchors 1 to 8 (kPa)");
}

std::vector<Line3> first_skeleton(const Model& model, const State& state) {
  std::vector<Line3> beams = straight_beams(model, state);
  beams.resize(std::min(beams.size(), model.anchor.size()));
  return beams;
}

}  // namespace

Sheet cui_xiao_2008(const std::string& folder) {
  Sheet sheet(3);
  const SceneModel cylinder = shipped("grasp_cylinder_5", {"laws/cui_xiao_2008.toml"});
  const Moment held = moment_of(cylinder, kHeld_s);
  sheet.add(scene_panel(cylinder.model(), *at_rest(cylinder).state), "Fig. 1: hand", "15 parts, 21 degrees of freedom");
  sheet.add(scene_panel(cylinder.model(), *held.state, first_skeleton(cylinder.model(), *held.state), body_alone()),
            "Figs. 2, 4a: skeleton of one contact", "to the cylinder's eight anchors");
  sheet.add(displaced_anchors(cylinder, *held.state), "Fig. 3: anchors moved by one contact after another",
            "five fingers, every law as printed");
  for (const char* fingers : kFingers) {
    const SceneModel scene = shipped(std::string("grasp_cylinder_") + fingers, {"laws/cui_xiao_2008.toml"});
    sheet.add(scene_panel(scene.model(), *moment_of(scene, kHeld_s).state),
              std::string("Fig. 6: ") + fingers + " fingers", "every law as printed");
  }
  sheet.add(stresses(folder + "2008_fig7_printed/"), "Fig. 7: stress at the anchors", "as printed");
  sheet.add(stress_history(folder + "2008_fig7_printed/grasp_cylinder_5.stress.csv"),
            "Fig. 8: stress during the power grasp", "from zero to its largest");
  const SceneModel ball = shipped("grasp_sphere_5", {"bodies/sphere_rings.toml"});
  sheet.add(scene_panel(ball.model(), *at_rest(ball).state, {}, body_alone()), "Fig. 4b: anchors of a sphere", "six");
  for (const char* fingers : kFingers) {
    const SceneModel scene = shipped(std::string("grasp_sphere_") + fingers, {"bodies/sphere_rings.toml"});
    sheet.add(scene_panel(scene.model(), *moment_of(scene, kHeld_s).state),
              std::string("Fig. 9: ") + fingers + " fingers", "sphere of 3,480 triangles");
  }
  return sheet;
}

}  // namespace palpate::papers
