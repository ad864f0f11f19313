#include <algorithm>
#include <cmath>

#include "config/fem/linear_body.h"
#include "tests/published/sheets/papers.h"
#include "tests/published/sheets/plot_panel.h"
#include "tests/published/sheets/scene_panel.h"

namespace palpate::papers {

namespace {

// The tube held with its centre at this height.
Moment tube_at(const SceneModel& scene, double height_mm) {
  std::vector<TimedPose> poses;
  for (int i = 0; i < 100; ++i) poses.push_back({1e-3 * i, {{0, 1e-3 * height_mm, 0}, {}}, {}});
  return moment_of(scene, poses, 1);
}

// Nodes that touch, at rest, the planes that the tube's surface gives them, and how hard each pushes: section across
// the tube.
Canvas planes_of_nodes(const Moment& moment) {
  Canvas canvas(kPanelWidth, kPanelHeight, kPaper);
  constexpr double kScale = 7.6;  // pixels a millimetre
  const auto at = [](Vec3 p) {
    return Point2{0.5 * kPanelWidth + kScale * 1e3 * p.x, 0.56 * kPanelHeight - kScale * (1e3 * p.y - 11)};
  };
  Stroke tube;
  for (int i = 0; i <= 120; ++i)
    tube.push_back(at({0.010 * std::cos(2 * kPi * i / 120), 0.011 + 0.010 * std::sin(2 * kPi * i / 120), 0}));
  canvas.polyline(tube, 2, kGrey);
  double most = 0;
  for (const Contact& c : moment.contact) most = std::max(most, c.force_N);
  for (const Contact& c : moment.contact) {
    const Vec3 along{-c.normal_w.y, c.normal_w.x, 0}, touched = Vec3{0, 0.011, c.position_w.z} - 0.010 * c.normal_w;
    canvas.polyline(Stroke{at(touched - 3e-3 * along), at(touched + 3e-3 * along)}, 1.6, kSeries[0]);
    canvas.polyline(Stroke{at(c.position_w), at(touched)}, 1, kGrey, 0.6);
    if (c.force_N > 0)
      canvas.polyline(Stroke{at(touched), at(touched + (6e-3 * c.force_N / most) * c.normal_w)}, 2, kSeries[1]);
    const Point2 node = at(c.position_w);
    canvas.rectangle(node.x - 2, node.y - 2, 4, 4, kInk);
  }
  canvas.text(10, 16, "black: nodes at rest, blue: the planes they are held by", 11, kInk);
  canvas.text(10, 31, "red: pushes on the tube", 11, kInk);
  return canvas;
}

Canvas pushes_of_nodes(const Moment& moment) {
  PlotCurve touching{"", {}, {}};
  for (const Contact& c : moment.contact) {
    touching.x.push_back(static_cast<double>(touching.x.size()) + 1), touching.y.push_back(c.force_N);
  }
  return plot_panel({touching}, "node near the tube", "push (N)", PlotKind::kBars);
}

// One element, E = 1, held at its base, a unit load down at its apex: how the edge between the two gives, with middle
// nodes on every edge, with one on that edge alone (the transition element), and with none.
Canvas transition() {
  const auto edge = [](const char* name, bool quadratic, const std::vector<std::size_t>& straight) {
    TetMesh mesh;
    mesh.node_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.tet.resize(1);
    for (std::size_t k = 0; k < 4; ++k) mesh.tet[0].node[k] = static_cast<std::int32_t>(k);
    for (std::size_t e = 0; quadratic && e < 6; ++e) {
      mesh.tet[0].node[4 + e] = static_cast<std::int32_t>(4 + e);
      mesh.node_m.push_back(0.5 * (mesh.node_m[static_cast<std::size_t>(kTetEdge[e][0])] +
                                   mesh.node_m[static_cast<std::size_t>(kTetEdge[e][1])]));
    }
    Supports supports = hold_where(mesh, [](Vec3 p) { return p.z == 0; });
    for (const std::size_t e : straight) {
      mesh.tet[0].node[4 + e] = -1;
      supports[4 + e] = kHoldAll;
    }
    std::vector<Vec3> force(mesh.node_m.size());
    force[3] = {0, 0, -1};
    const std::vector<Vec3> moved = LinearBody(mesh, {1, 0.25}, supports, "tet").solve_m(force);
    const double apex = -moved[3].z, middle = quadratic ? -moved[7].z : 0.5 * apex;
    PlotCurve curve{name, {}, {}};
    for (int i = 0; i <= 40; ++i) {
      const double s = i / 40.0;
      curve.x.push_back(s), curve.y.push_back(4 * (0.5 * apex - middle) * s * (1 - s));
    }
    return curve;
  };
  return plot_panel({edge("quadratic", true, {}), edge("transition", true, {4, 5}), edge("linear", false, {})},
                    "along the edge, from its held end", "departure from a straight edge");
}

}  // namespace

Sheet duriez_2003(const std::string& folder) {
  Sheet sheet(3);
  const SceneModel snap = shipped("snap_in_paper");
  const struct {
    double height_mm;
    const char* words;
  } frames[] = {{13, "the tube meets both arms"},
                {11, "the arms open: the largest force"},
                {6, "past the middle: the arms pull it in"},
                {0, "seated"}};
  for (const auto& frame : frames)
    sheet.add(scene_panel(snap.model(), *tube_at(snap, frame.height_mm).state, {}, {StandardView::kFront, 2e-3, true}),
              "Fig. 5: the snap", frame.words);
  const Table run(folder + "2003_tube.csv"), prism(folder + "2003_prism.csv");
  sheet.add(plot_panel({{"tube", scaled(run["y_mm"], -1, 14.5), run["fy_N"]},
                        {"prism of 16 sides", scaled(prism["y_mm"], -1, 14.5), prism["fy_N"]}},
                       "inserted (mm)", "force on the tool (N)"),
            "Figs. 5, 6: pushes, then pulls", "without friction; any shaped object");
  const Moment open = tube_at(snap, 11);
  sheet.add(transition(), "Fig. 2: transition element", "middle nodes on every edge, on one, on none");
  sheet.add(planes_of_nodes(open), "Fig. 3: plane of a node", "section at the largest force");
  sheet.add(pushes_of_nodes(open), "Fig. 1: pushes of the nodes that touch", "none inside the tube, to 1e-18 m");
  return sheet;
}

}  // namespace palpate::papers
