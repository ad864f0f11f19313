// `palpate grasp`: plays the scripted grasps of hand scenes and draws what they do to the body.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "config/hand/hand_model.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/overlay_options.h"
#include "sim_host/press/grasp_run.h"
#include "sim_host/press/grasp_stability.h"
#include "sim_host/run/run_json.h"
#include "sim_host/view/line_plot.h"
#include "sim_host/view/picture.h"

namespace palpate {

namespace {

struct GraspCommand {
  std::vector<std::string> scenes;
  SceneOverlays overlays;
  std::string out = "grasp";
  double hand_N_per_m = 0;
  bool order = false, json = false;
  VerdictLimits limits;
};

void write_csv(const std::string& path, const Model& model, const GraspRun& run) {
  std::ofstream file(path);
  file << "time_s";
  for (std::size_t a = 0; a < model.anchor.size(); ++a) file << ",anchor" << a + 1 << "_Pa";
  file << '\n';
  for (std::size_t i = 0; i < run.time_s.size(); ++i) {
    file << fmt::format("{:.6g}", run.time_s[i]);
    for (const std::vector<double>& anchor : run.stress_Pa) file << fmt::format(",{:.9g}", anchor[i]);
    file << '\n';
  }
  if (!file) throw std::runtime_error(path + ": cannot write");
}

PlotCurve stress_by_anchor(const GraspRun& run) {
  PlotCurve curve{run.name, {}, {}};
  for (std::size_t a = 0; a < run.held_stress_Pa.size(); ++a) {
    curve.x.push_back(static_cast<double>(a + 1));
    curve.y.push_back(1e-3 * run.held_stress_Pa[a]);
  }
  return curve;
}

Drawing history_plot(const GraspRun& run) {
  std::vector<PlotCurve> curves;
  for (std::size_t a = 0; a < run.stress_Pa.size(); ++a) {
    PlotCurve curve{fmt::format("anchor {}", a + 1), run.time_s, {}};
    for (const double stress : run.stress_Pa[a]) curve.y.push_back(1e-3 * stress);
    curves.push_back(std::move(curve));
  }
  return line_plot(curves, {run.name + ": stress at each anchor", "time (s)", "stress (kPa)"}, false);
}

Json json_of(Vec3 v) { return {v.x, v.y, v.z}; }

// A finger takes part when its closing moves a joint.
bool takes_part(const Model& model, std::int32_t finger) {
  return std::ranges::any_of(model.joint,
                             [&](const Joint& joint) { return joint.finger == finger && joint.closed != joint.open; });
}

Json run_json(const Model& model, const GraspRun& run, const GraspStability& s) {
  Json json = {{"name", run.name},
               {"regions", run.regions},
               {"force_N", json_of(run.contact_w.force_N)},
               {"palm_force_N", json_of(run.palm_w.force_N)},
               {"holds", s.holds},
               {"left_for_friction_N", left_for_friction_N(grasp_of(model, *run.held))},
               {"imbalance_N", s.imbalance_N},
               {"friction_needed", s.friction_needed < kHuge ? Json(s.friction_needed) : Json(nullptr)},
               {"force_closure", s.closed},
               {"quality_least", s.quality_least},
               {"quality_most", s.quality_most},
               {"chatter", run.chatter},
               {"back_at_rest", run.back_at_rest},
               {"ticks", run.ticks},
               {"unconverged_ticks", run.unconverged_ticks}};
  for (std::size_t part = 1; part < run.part_force_N.size(); ++part)
    if (run.part_force_N[part] > 0) json["part_force_N"][hand_parts()[part - 1].name] = run.part_force_N[part];
  for (std::int32_t f = 0; f < kMaxFingers; ++f)
    if (takes_part(model, f)) json["finger_force_N"][finger_name(f)] = run.finger_force_N[f];
  for (std::size_t a = 0; a < run.held_stress_Pa.size(); ++a)
    json["anchors"].push_back(
        {{"position_m", json_of(model.anchor[a].position_m)}, {"stress_Pa", run.held_stress_Pa[a]}});
  return json;
}

std::string fingers_text(const Model& model, const GraspRun& run) {
  std::string text;
  for (std::int32_t f = 0; f < kMaxFingers; ++f) {
    if (!takes_part(model, f)) continue;
    const double force_N = run.finger_force_N[f];
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", finger_name(f),
                        force_N > 0 ? fmt::format("{:.4f} N", force_N) : "meets NOTHING");
  }
  return text;
}

Json print_run(const Model& model, const GraspRun& run) {
  fmt::print(
      "{}: {} regions, sum of fingers on the hand ({:.3f}, {:.3f}, {:.3f}) N, palm on the body ({:.3f}, {:.3f}, "
      "{:.3f}) N\n",
      run.name, run.regions, run.contact_w.force_N.x, run.contact_w.force_N.y, run.contact_w.force_N.z,
      run.palm_w.force_N.x, run.palm_w.force_N.y, run.palm_w.force_N.z);
  const Grasp grasp = grasp_of(model, *run.held);
  const GraspStability s = judge(grasp);
  fmt::print("  {}: within the friction cones fingers and palm {} the weight of {:.2f} N{}; friction needed: {}\n",
             s.holds ? "stable" : "UNSTABLE", s.holds ? "balance" : "do not balance", norm(grasp.weight_N),
             s.holds ? "" : fmt::format(" by {:.3f} N", s.imbalance_N),
             s.friction_needed < kHuge ? fmt::format("{:.3f} of it", s.friction_needed) : "no amount would do");
  if (s.closed) {
    fmt::print("  force closure: yes, quality {:.4f} to {:.4f}\n", s.quality_least, s.quality_most);
  } else {
    fmt::print("  force closure: no\n");
  }
  fmt::print("  normal force of each finger: {}; the palm's push leaves {:.3f} N of them for friction\n",
             fingers_text(model, run), left_for_friction_N(grasp));
  fmt::print("  normal force on each part, and stress at each anchor\n");
  for (std::size_t part = 1; part < run.part_force_N.size(); ++part)
    if (run.part_force_N[part] > 0)
      fmt::print("  {:<18}{:8.4f} N\n", hand_parts()[part - 1].name, run.part_force_N[part]);
  for (std::size_t a = 0; a < run.held_stress_Pa.size(); ++a) {
    const Vec3 at = 1e3 * model.anchor[a].position_m;
    fmt::print("  anchor {:<2} ({:7.2f}, {:7.2f}, {:7.2f}) mm{:10.1f} Pa\n", a + 1, at.x, at.y, at.z,
               run.held_stress_Pa[a]);
  }
  fmt::print("  largest change per tick while held {:.2e} of the force; opened: {}\n", run.chatter,
             run.back_at_rest ? "exactly at rest" : "NOT at rest");
  return run_json(model, run, s);
}

// How much the order of contact matters: thumb first against thumb last, everything else the same.
Json print_order(const Model& model, const SceneDesc& scene) {
  Json json;
  for (const CouplingLaw law : {CouplingLaw::kCoupled, CouplingLaw::kTemporalPaper}) {
    Model varied = model;
    varied.params.coupling_law = law;
    varied.params.friction_law = FrictionLaw::kNone;
    varied.params.stop_force_N = 1e6;  // every finger ends where the preshape says
    GraspOptions fingers_late, thumb_late;
    for (std::size_t f = 1; f < kMaxFingers; ++f) fingers_late.delay_s[f] = 0.3;
    thumb_late.delay_s[0] = 0.3;
    const GraspRun a = run_grasp(varied, scene, fingers_late), b = run_grasp(varied, scene, thumb_late);
    const char* name = law == CouplingLaw::kCoupled ? "coupled" : "temporal";
    json[name] = force_difference(a, b);
    fmt::print("  thumb first against thumb last, {}: forces differ by {:.3e} of the largest\n", name,
               force_difference(a, b));
  }
  return json;
}

int run(const GraspCommand& command, Json& json) {
  std::filesystem::create_directories(command.out);
  const auto file = [&](const std::string& name) { return command.out + "/" + name; };
  std::vector<PlotCurve> curves;
  bool rest = true;
  std::vector<RunVerdict> verdicts;  // one a scene
  for (const std::string& path : command.scenes) {
    const SceneModel scene(path, command.overlays);
    if (!scene.scene()) throw std::runtime_error(path + ": an image holds no path; name the scene's .toml");
    GraspOptions options;
    options.hand_N_per_m = command.hand_N_per_m;
    const GraspRun played = run_grasp(scene.model(), *scene.scene(), options);
    json["grasps"].push_back(print_run(scene.model(), played));
    if (command.order) json["grasps"].back()["order_share"] = print_order(scene.model(), *scene.scene());
    rest = rest && played.back_at_rest;
    verdicts.push_back(judge_unconverged(played.unconverged_ticks, played.ticks, command.limits));
    curves.push_back(stress_by_anchor(played));
    write_csv(file(played.name + ".stress.csv"), scene.model(), played);
    history_plot(played).save(file(played.name + ".stress.png"));
    save_picture(file(played.name + ".png"), scene.model(), *played.held);
  }
  bar_plot(curves, {"stress at the anchors while held", "anchor", "stress (kPa)"}).save(file("anchors.png"));
  fmt::print("wrote   {}: anchors.png, and for each scene a picture, a stress history and its table\n", command.out);
  json["folder"] = command.out;
  json["verdicts"] = verdicts_json(verdicts);
  fmt::print("{}", verdict_text(verdicts));
  return rest && all_ok(verdicts) ? kExitOk : kExitFailed;
}

}  // namespace

void add_grasp_command(CLI::App& app, int& exit_code) {
  auto settings = std::make_shared<GraspCommand>();
  CLI::App* command =
      app.add_subcommand("grasp", "Play the grasps of hand scenes: stresses, pictures, order dependence");
  command->add_option("SCENES", settings->scenes, "scenes (.toml) with a [hand]")->required();
  command->add_option("--out", settings->out, "folder for pictures, plots and tables")->capture_default_str();
  command
      ->add_option("--hand", settings->hand_N_per_m,
                   "stiffness (N/m) of the arm that holds the wrist; 0: the wrist is where the path says")
      ->capture_default_str()
      ->check(number_in(0, 1e6));
  add_overlay_options(*command, settings->overlays);
  add_allow_option(*command, settings->limits, {"unconverged"});
  command->add_flag("--order", settings->order, "also close the thumb first and last, with both coupling laws");
  command->footer(
      "Example:\n"
      "  palpate grasp config/scenes/grasp_cylinder_2.toml config/scenes/grasp_cylinder_3.toml \\\n"
      "    config/scenes/grasp_cylinder_5.toml --order --out grasps\n"
      "  palpate grasp config/scenes/grasp_cylinder_5.toml --with config/scenes/laws/cui_xiao_2008.toml");
  add_json_flag(*command, settings->json);
  command->callback([settings, &exit_code] {
    exit_code = run_with_json(settings->json, "grasp", [&](Json& json) { return run(*settings, json); });
  });
}

}  // namespace palpate
