#include <algorithm>
#include <cmath>

#include "rt_core/contact/friction.h"
#include "rt_core/skeleton/straight_beam.h"
#include "sim_host/view/anchors.h"
#include "sim_host/view/deformed_surface.h"
#include "tests/published/sheets/papers.h"
#include "tests/published/sheets/plot_panel.h"
#include "tests/published/sheets/scene_panel.h"

namespace palpate::papers {

namespace {

constexpr double kPressed_s = 3.0, kSlid_s = 8.0;  // the mallet of Fig. 10 stands pressed; has slid off the pole

// How far the surface went down along the section through the contact, upper side.
PlotCurve section(const std::string& name, const DeformedSurface& surface) {
  std::vector<Point2> points;
  for (std::size_t v = 0; v < surface.rest_m.size(); ++v)
    if (std::abs(surface.rest_m[v].z) < 0.8e-3 && surface.normal[v].y > 0)
      points.push_back({1e3 * surface.rest_m[v].x, 1e3 * surface.displacement_m[v].y});
  std::ranges::sort(points, {}, &Point2::x);
  PlotCurve curve{name, {}, {}};
  for (const Point2& p : points) curve.x.push_back(p.x), curve.y.push_back(p.y);
  return curve;
}

Canvas dents() {
  const auto shape = [](const std::vector<std::string>& settings) {
    const SceneModel scene = shipped("ellipsoid_mallet_paper", {}, settings);
    return refined_surface(scene.model(), *moment_of(scene, kSlid_s).state, 60'000);
  };
  return plot_panel({section("as a whole (Fig. 1b)", shape({"shape.neighbourhood=none", "shape.interpolation=rbf"})),
                     section("with its neighbourhood", shape({"shape.interpolation=rbf"}))},
                    "x (mm)", "motion of the surface (mm)");
}

// The worked example of tests/published: 5 N, f_max = 4 N, mu_D F = 2.5 N, along and back.
Canvas stick_and_slip() {
  std::vector<PlotCurve> curves;
  for (const FrictionLaw law : {FrictionLaw::kPaper, FrictionLaw::kReturnMap}) {
    FrictionParameters p;
    p.law = law, p.k_N = 0.8 * std::pow(5, 0.25), p.beta = 0.75, p.mu_dynamic = 0.5;
    p.contact = {40, 3e8, kHuge};
    FrictionMemory memory;
    FrictionLoad load;
    load.normal_w = {0, 1, 0}, load.force_N = 5, load.depth_m = law_depth_m(p.contact, 5);
    friction_step(p, load, memory);
    PlotCurve curve{law == FrictionLaw::kPaper ? "as printed" : "corrected", {}, {}};
    double x = 0;
    for (int i = 0; i <= 700; ++i) {
      const double to = i <= 400 ? 0.01 * i : 4 - 0.01 * (i - 400);
      load.step_w = {1e-3 * (to - x), 0, 0};
      x = to;
      curve.x.push_back(x), curve.y.push_back(-friction_step(p, load, memory).force_w.x);
    }
    curves.push_back(std::move(curve));
  }
  return plot_panel(curves, "tangential travel, to 4 mm and back (mm)", "friction (N)");
}

Canvas region_points(const Moment& pressed) {
  PlotCurve points{"points in contact", {}, {}}, centre{"their geometric centre", {0}, {0}},
      pressure{"centre of pressure", {0}, {0}};
  double force = 0;
  for (const Contact& c : pressed.contact) {
    points.x.push_back(1e3 * c.position_w.x), points.y.push_back(1e3 * c.position_w.z);
    centre.x[0] += 1e3 * c.position_w.x / static_cast<double>(pressed.contact.size());
    centre.y[0] += 1e3 * c.position_w.z / static_cast<double>(pressed.contact.size());
    pressure.x[0] += 1e3 * c.force_N * c.position_w.x, pressure.y[0] += 1e3 * c.force_N * c.position_w.z;
    force += c.force_N;
  }
  pressure.x[0] /= force, pressure.y[0] /= force;
  return plot_panel({points, centre, pressure}, "x (mm)", "z (mm)", PlotKind::kMarks);
}

// The line that a clamped beam takes under a tip force across it: the point that its release length reaches.
Canvas bent_beam() {
  StraightBeam beam;
  beam.axis = {1, 0, 0}, beam.length_m = 0.04;
  PlotCurve line{"v(x) = F/(EI) (l x^2/2 - x^3/6)", {}, {}};
  for (int i = 0; i <= 80; ++i) {
    const double x = 0.04 * i / 80;
    line.x.push_back(1e3 * x), line.y.push_back(1e3 * released_displacement(beam, {0, 1e-3, 0}, x).y);
  }
  return plot_panel({line}, "from the clamped end (mm)", "deflection (mm)");
}

Canvas anchor_forces(const SceneModel& scene, const State& state) {
  std::vector<PlotCurve> series;
  const SceneModel shared = shipped("ellipsoid_mallet_paper", {}, {"skeleton.law=stiffness"});
  for (const SceneModel* model : {&scene, &shared}) {
    const AnchorField field = anchors_of(model->model(), state);
    PlotCurve bars{model == &scene ? "eqs. 6 to 8" : "by stiffness", {}, {}};
    for (std::int32_t a = 0; a < field.count; ++a)
      bars.x.push_back(a + 1), bars.y.push_back(norm(field.anchor[a].force_w));
    series.push_back(std::move(bars));
  }
  return plot_panel(series, "anchor", "force on its beam (N)", PlotKind::kBars);
}

}  // namespace

Sheet luo_xiao_2006(const std::string& folder) {
  Sheet sheet(3);
  const SceneModel mallet = shipped("ellipsoid_mallet_paper"),
                   compass = shipped("heart_compass_paper", {"laws/luo_xiao_2006.toml"});
  const Moment pressed = moment_of(mallet, kPressed_s), sliding = moment_of(mallet, 6.5);
  sheet.add(dents(), "Figs. 1, 8: dents", "section, by RBF; the anchor at 0 keeps still");
  sheet.add(stick_and_slip(), "Figs. 2, 3: stick, slip, and back", "one point under 5 N");
  sheet.add(region_points(sliding), "Figs. 4, 5: region, equivalent point",
            "the mallet while it slides, seen from above");
  sheet.add(scene_panel(mallet.model(), *pressed.state, straight_beams(mallet.model(), *pressed.state), body_alone()),
            "Fig. 6: beam skeleton", "from the contact to the six anchors");
  sheet.add(bent_beam(), "Fig. 7: bent beam", "tip moved across by 1 mm");
  sheet.add(anchor_forces(mallet, *pressed.state), "Eqs. 6 to 8: shares of the beams", "mallet pressed with 3 N");
  const Table fig10(folder + "2006_fig10.csv");
  sheet.add(plot_panel({{"f_x", scaled(fig10["time_s"], 1e3), fig10["fx_N"]},
                        {"f_y", scaled(fig10["time_s"], 1e3), fig10["fy_N"]},
                        {"size", scaled(fig10["time_s"], 1e3), fig10["f_N"]}},
                       "time (ms)", "force (N)"),
            "Fig. 10: force of the sliding mallet", "axis to 25 N, as theirs");
  sheet.add(scene_panel(mallet.model(), *sliding.state), "Fig. 10: mallet on the ellipsoid", "while it slides");
  const Moment one = moment_of(compass, 3.8), two = moment_of(compass, 7.0);
  sheet.add(scene_panel(compass.model(), *two.state, straight_beams(compass.model(), *two.state, true), body_alone()),
            "Fig. 9: two skeletons", "each ends at the other contact, too");
  sheet.add(scene_panel(compass.model(), *one.state, {}, colours_to(5e-3)), "Fig. 12: one contact region",
            "compass on the heart, every law as printed");
  sheet.add(scene_panel(compass.model(), *two.state, {}, colours_to(5e-3)), "Fig. 12: two contact regions",
            "the same colours");
  return sheet;
}

}  // namespace palpate::papers
