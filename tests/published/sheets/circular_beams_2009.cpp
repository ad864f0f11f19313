#include "config/beams/circular_beam.h"
#include "sim_host/press/pose_csv.h"
#include "tests/published/sheets/papers.h"
#include "tests/published/sheets/plot_panel.h"
#include "tests/published/sheets/scene_panel.h"

namespace palpate::papers {

namespace {

// Through the clamp of an arc of 60 degrees, radii 30 and 40 mm, 10 mm thick, under F1 = 1 N and F2 = 1 N as printed.
Canvas section_stresses() {
  const ArcSection arc{30e-3, 40e-3, 10e-3};
  std::vector<PlotCurve> curves(3);
  curves[0].name = "tangential, F1", curves[1].name = "tangential, F2", curves[2].name = "radial, F1";
  for (int i = 0; i <= 60; ++i) {
    const double r = 30e-3 + 10e-3 * i / 60;
    const PolarStress first = arc_stress_paper(arc, 1, 0, r, kPi / 3), second = arc_stress_paper(arc, 0, 1, r, kPi / 3);
    const double stress[3] = {first.hoop_Pa, second.hoop_Pa, first.radial_Pa};
    for (std::size_t k = 0; k < 3; ++k) curves[k].x.push_back(1e3 * r), curves[k].y.push_back(1e-3 * stress[k]);
  }
  return plot_panel(curves, "radius (mm)", "stress (kPa)");
}

Canvas forces_at(const std::string& file, int first) {
  const Table table(file);
  std::vector<PlotCurve> curves;
  for (int a = first; a < first + 5; ++a) {
    const std::string number = std::to_string(a);
    curves.push_back({"anchor " + number, table["depth_mm"], table["a" + number + "_F_N"]});
  }
  return plot_panel(curves, "depth (mm)", "force (N)");
}

}  // namespace

Sheet circular_beams_2009(const std::string& folder) {
  Sheet sheet(3);
  const SceneModel shell = shipped("half_shell_paper"), ring = shipped("ring_paper", {"laws/circular_beams_2009.toml"}),
                   hollow = shipped("hollow_cylinder_paper");
  const struct {
    const SceneModel& scene;
    const char* name;
  } bodies[] = {
      {shell, "half elliptical shell, 5,400 triangles"}, {ring, "ring, 2,304"}, {hollow, "hollow cylinder, 3,024"}};
  for (const auto& body : bodies)
    sheet.add(scene_panel(body.scene.model(), *at_rest(body.scene).state, {}, body_alone()),
              "Fig. 2: objects with holes", body.name);
  const std::string path = std::string(PALPATE_SOURCE_DIR) + "/docs/pictures/half_shell_press.csv";
  const double period_s = shell.model().params.period_s;
  const Moment pressed = moment_of(shell, resample(read_pose_file(path, period_s), period_s), 2);
  sheet.add(section_stresses(), "Fig. 3: circular cantilever beam", "stresses through its clamp, as printed");
  sheet.add(scene_panel(shell.model(), *pressed.state, circular_beams(shell, *pressed.state), body_alone()),
            "Figs. 1, 4, 5: skeleton of circular beams", "from the contact to outer and inner anchors");
  sheet.add(scene_panel(shell.model(), *pressed.state, {}, body_alone()), "Fig. 7: half shell, pressed by 2.4 mm",
            "dent and rim at rest");
  sheet.add(forces_at(folder + "2009_fig8.csv", 1), "Fig. 8: force at the outer anchors", "beams shared by stiffness");
  sheet.add(forces_at(folder + "2009_fig8.csv", 6), "Fig. 8: at the inner anchors", "\"results are similar\"");
  sheet.add(forces_at(folder + "2009_fig8_printed_anchors.csv", 1), "Fig. 8, sharing as printed",
            "of a contact of 4.24 N");
  sheet.add(scene_panel(ring.model(), *moment_of(ring, 4).state, {}, body_alone()), "Fig. 9: ring",
            "every law as printed");
  const SceneModel held = shipped("grasp_cylinder_5", {"bodies/hollow_cylinder.toml"});
  sheet.add(scene_panel(held.model(), *moment_of(held, 3.4).state), "Fig. 10: hand on the hollow cylinder",
            "15 regions");
  return sheet;
}

}  // namespace palpate::papers
