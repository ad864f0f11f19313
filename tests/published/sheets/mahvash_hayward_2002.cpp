#include <cmath>

#include "rt_core/surface/smooth_foot.h"
#include "tests/published/sheets/papers.h"
#include "tests/published/sheets/plot_panel.h"
#include "tests/published/sheets/scene_panel.h"

namespace palpate::papers {

namespace {

constexpr const char* kTools[] = {"sphere_12_7", "flat_3_2", "sphere_3_2"};
constexpr const char* kNames[] = {"sphere 12.7 mm", "flat 3.2 mm", "sphere 3.2 mm"};

// Height of the path to depth below the body's top line of 200 mm; the tip is 20 mm below the tool's frame.
std::vector<double> depth_of(const Table& table, double top_mm = 200) { return scaled(table["y_mm"], -1, top_mm + 20); }

PlotCurve until(PlotCurve curve, double most_x) {
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (curve.x[i] > most_x) curve.x.resize(i), curve.y.resize(i);
  return curve;
}

Canvas three_tools(const std::string& folder, const std::string& kind, double most_mm) {
  std::vector<PlotCurve> curves;
  for (int k = 0; k < 3; ++k) {
    const Table table(folder + "2002_" + kind + "_" + kTools[k] + ".csv");
    curves.push_back(until({kNames[k], depth_of(table), table["f_N"]}, most_mm));
  }
  return plot_panel(curves, "displacement (mm)", "force (N)");
}

// Measured against the printed law: their sphere of 3.2 mm, Table 1 and the run, below 12 N.
Canvas table_one(const std::string& folder) {
  const Table run(folder + "2002_table1_sphere_3_2.csv");
  PlotCurve law{"table 1: 4/3 sqrt(R) E* d^1.5", {}, {}}, sphere{"a true sphere", {}, {}};
  for (int i = 0; i <= 160; ++i) {
    const double d = 0.01 * i;
    law.x.push_back(d), law.y.push_back(4.0 / 3 * std::sqrt(1.6) * 3.45 * std::pow(d, 1.5));
  }
  const Table ball(folder + "2002_true_sphere.csv");
  return plot_panel({law, until({"on the cylinder of 100 mm", depth_of(run), run["f_N"]}, 1.6),
                     until({"a true sphere, derived", depth_of(ball), ball["f_N"]}, 1.5)},
                    "displacement (mm)", "force (N)");
}

// Area coordinates under a tip that goes straight over three triangles: each vertex's own function.
Canvas area_coordinates() {
  const double corner[5][2] = {{0, 0}, {10, 0}, {5, 8.66}, {15, 8.66}, {20, 0}};
  const int triangle[3][3] = {{0, 1, 2}, {1, 3, 2}, {1, 4, 3}};
  std::vector<PlotCurve> curves(5);
  for (std::size_t v = 0; v < 5; ++v) curves[v].name = "n_" + std::to_string(v + 1);
  for (int i = 0; i <= 200; ++i) {
    const double x = 2 + 16.0 * i / 200, y = 3;
    for (const auto& t : triangle) {
      double n[3];
      bool inside = true;
      const auto area = [&](double ax, double ay, double bx, double by) {
        return (ax - x) * (by - y) - (bx - x) * (ay - y);
      };
      double all = 0;
      for (int k = 0; k < 3; ++k) {
        const double *a = corner[t[(k + 1) % 3]], *b = corner[t[(k + 2) % 3]];
        n[k] = area(a[0], a[1], b[0], b[1]);
        inside = inside && n[k] >= 0;
        all += n[k];
      }
      if (!inside) continue;
      for (int v = 0; v < 5; ++v) {
        double weight = 0;
        for (int k = 0; k < 3; ++k) weight += t[k] == v ? n[k] / all : 0;
        curves[static_cast<std::size_t>(v)].x.push_back(x), curves[static_cast<std::size_t>(v)].y.push_back(weight);
      }
      break;
    }
  }
  return plot_panel(curves, "way of the contact point (mm)", "share of a vertex");
}

}  // namespace

Sheet mahvash_hayward_2002(const std::string& folder) {
  Sheet sheet(3);
  const SceneModel layer = shipped("tools_on_layer");
  const Moment pressed = moment_of(layer, 6);
  sheet.add(scene_panel(layer.model(), *pressed.state), "Figs. 1, 2: tool on an elastic body",
            "localised: a sphere on the liver");
  sheet.add(area_coordinates(), "Fig. 3: area coordinates", "over three triangles: continuous at their edges");
  sheet.add(three_tools(folder, "global", 6), "Figs. 4c, 5: the body gives as a whole",
            "c0 = 3 mm/N: every tool the same");
  const Table loop(folder + "2002_fig5_loop.csv");
  sheet.add(plot_panel({{"in, and back: 3 % are lost", depth_of(loop), loop["f_N"]}}, "displacement (mm)", "force (N)"),
            "Fig. 5: loading and unloading", "sphere of 12.7 mm");
  sheet.add(three_tools(folder, "local", 1.8), "Figs. 4d, 6: localised deformation", "tools differ");
  sheet.add(table_one(folder), "Fig. 6: Table 1 below 12 N", "sphere of 3.2 mm, E* = 3.45 MPa");
  const Table large(folder + "2002_fig7_sphere_12_7.csv"), small(folder + "2002_fig7_sphere_3_2_true.csv");
  sheet.add(
      plot_panel({{"sphere 12.7 mm", large["time_s"], large["f_N"]}, {"sphere 3.2 mm", small["time_s"], small["f_N"]}},
                 "time (s)", "force (N)"),
      "Figs. 4e, 7: liver 10 mm deep", "tools differ");
  const Table slide(folder + "2002_fig8_sphere_3_2.csv");
  sheet.add(
      plot_panel({{"normal, f_z", slide["time_s"], slide["fy_N"]}, {"friction, f_x", slide["time_s"], slide["fx_N"]}},
                 "time (s)", "force (N)"),
      "Figs. 8c, d: sliding to and fro", "the normal force does not change");
  sheet.add(plot_panel({{"friction against x", slide["x_mm"], slide["fx_N"]}}, "x (mm)", "f_x (N)"),
            "Fig. 8f: friction against x", "turned round over 1.8 mm");
  const Table printed(folder + "2002_printed.csv");
  sheet.add(
      plot_panel({{"normal force", printed["x_mm"], printed["fy_N"]}, {"friction", printed["x_mm"], printed["fx_N"]}},
                 "x (mm)", "force (N)"),
      "Eqs. 3, 4, as printed", "over to a place half as stiff, and half way back");
  return sheet;
}

}  // namespace palpate::papers
