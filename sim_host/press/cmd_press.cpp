// `palpate press`: drives the controller's own tick() through a list of tool poses, without a device.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <memory>
#include <optional>
#include <stdexcept>

#include "sim_host/bake/default_path.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/overlay_options.h"
#include "sim_host/press/anchor_loads.h"
#include "sim_host/press/force_csv.h"
#include "sim_host/run/joint_script.h"
#include "sim_host/run/run_json.h"
#include "sim_host/run/verdict.h"
#include "sim_host/status_text.h"
#include "sim_host/tick_memory.h"
#include "sim_host/view/picture.h"
#include "sim_host/view/plot.h"
#include "sim_host/view/vtu.h"

namespace palpate {

namespace {

struct PressOptions {
  std::string scene, path = "demo", out = "forces.csv", vtu, png, plot, anchors, anchor_plot;
  std::vector<int> plotted_anchors;
  SceneOverlays overlays;
  int every = 1;
  bool resample = false, json = false;
  JointOptions joints;
  VerdictLimits limits;
  double hand_N_per_m = -1;  // -1: the scene's for the demo, otherwise none
};

// `demo`: what the scene scripts; of an image, what is done where nothing is scripted.
PathDesc demo_path(const SceneModel& scene) {
  if (!scene.scene()) return path_of_image(scene.model());
  if (scene.scene()->path.point.empty())
    throw std::runtime_error(
        "--path demo: the scene has no [[path.point]], and how fingers close is not to be guessed");
  if (scene.scene()->device.holds == HeldPart::kTwoTools)
    throw std::runtime_error(
        "--path demo: two hands move this scene, and a press moves the first one's tool alone; play both with "
        "`palpate run`, or give --path CSV");
  return scene.scene()->path;
}

std::vector<TimedPose> poses_of(const PressOptions& options, const SceneModel& scene) {
  const double period_s = scene.model().params.period_s;
  if (options.path != "demo") {
    const std::vector<TimedPose> poses = read_pose_file(options.path, period_s);
    return options.resample ? resample(poses, period_s) : poses;
  }
  return scripted_poses(demo_path(scene), period_s);
}

PressDrive drive_of(const PressOptions& options, const SceneModel& scene) {
  if (options.hand_N_per_m >= 0) return {options.hand_N_per_m};
  return {options.path == "demo" ? demo_path(scene).hand_stiffness_N_per_m : 0.0};
}

// Rewrites one line of a terminal; silent when the output is not a terminal.
class PressProgress {
 public:
  explicit PressProgress(std::size_t total) : total_(total), shown_(isatty(STDERR_FILENO) != 0 && total > 5000) {}
  ~PressProgress() {
    if (shown_) fmt::print(stderr, "\r\033[K");
  }
  PressProgress(const PressProgress&) = delete;
  PressProgress& operator=(const PressProgress&) = delete;
  void at(std::size_t done) const {
    if (shown_ && done % 1000 == 0)
      fmt::print(stderr, "\r{:3.0f} % of {} poses", 100.0 * static_cast<double>(done) / static_cast<double>(total_),
                 total_);
  }

 private:
  std::size_t total_;
  bool shown_;
};

// Keeps what the summary, the plot and the picture need.
struct Collected {
  std::vector<ForceSample> samples;
  std::vector<AnchorSample> anchors;
  std::uint64_t rows = 0;
  std::uint32_t fault = 0;
  struct Seen {
    std::uint64_t ticks = 0;
    double first_s = 0;
  };
  Seen status[32];  // of each status bit
  std::int64_t instructions_max = -1;
  double force_max_N = 0, depth_max_m = 0;
  StatePtr strongest;  // of the tick with the largest force

  void add(const PressRow& row, const State& state) {
    const Output& output = row.record.output;
    const double force = norm(output.contact_w.force_N);
    if (rows == 0 || force > force_max_N) {
      force_max_N = force;
      if (strongest == nullptr) strongest = copy_of(state);
      copy_state(state, *strongest);
    }
    rows += 1;
    see(output.status, row.time_s);
    fault |= output.fault;
    instructions_max = std::max(instructions_max, row.instructions);
    depth_max_m = std::max(depth_max_m, output.penetration_m);
    samples.push_back({row.time_s, output.contact_w.force_N, output.penetration_m, output.regions});
  }
  // The tick asks for no skeleton, so a degenerate one shows here only.
  void add_anchors(AnchorSample sample) {
    if (sample.degenerate > 0) see(Status::kSkeletonDegenerate, sample.time_s);
    anchors.push_back(std::move(sample));
  }

 private:
  void see(std::uint32_t bits, double time_s) {
    for (std::size_t bit = 0; bit < std::size(status); ++bit) {
      if ((bits >> bit & 1u) == 0) continue;
      if (status[bit].ticks++ == 0) status[bit].first_s = time_s;
    }
  }
};

void print_summary(const Collected& all, const PressOptions& options) {
  fmt::print("pressed {} poses: largest force {:.4g} N, deepest {:.4g} mm", all.rows, all.force_max_N,
             all.depth_max_m * 1e3);
  if (all.instructions_max >= 0) fmt::print(", costliest tick {} instructions", all.instructions_max);
  fmt::print("\n");
  for (const BitText& bit : status_bit_texts()) {
    const Collected::Seen& seen = all.status[bit.bit];
    if (seen.ticks == 0) continue;
    fmt::print("status  {} in {} ticks, first at {:.3f} s: {}\n        remedy: {}\n", bit.name, seen.ticks,
               seen.first_s, bit.meaning, bit.remedy);
  }
  for (const BitText& bit : fault_bit_texts()) {
    if ((all.fault >> bit.bit & 1u) != 0) fmt::print("FAULT   {}: {}; {}\n", bit.name, bit.meaning, bit.remedy);
  }
  fmt::print("wrote   {}\n", options.out);
}

void write_anchors(const PressOptions& options, const Model& model, const Collected& all) {
  if (!options.anchors.empty()) {
    write_anchor_csv(options.anchors, all.anchors);
    fmt::print("wrote   {}\n", options.anchors);
  }
  if (!options.anchor_plot.empty()) {
    const std::string title = fmt::format("{}: force at the anchors", model.name);
    anchor_force_plot(model, all.anchors, options.plotted_anchors, title).save(options.anchor_plot);
    fmt::print("wrote   {}\n", options.anchor_plot);
  }
}

void write_pictures(const PressOptions& options, const Model& model, const Collected& all) {
  if (!options.plot.empty()) {
    force_history_plot(all.samples, fmt::format("{}: {} poses", model.name, all.rows)).save(options.plot);
    fmt::print("wrote   {}\n", options.plot);
  }
  if (!options.png.empty()) {
    save_picture(options.png, model, *all.strongest);
    fmt::print("wrote   {}\n", options.png);
  }
}

void check_anchors(const PressOptions& options, const Model& model) {
  if (options.anchors.empty() && options.anchor_plot.empty()) return;
  const std::size_t count = model.anchor.size();
  if (count == 0)
    throw std::runtime_error(
        "--anchors, --anchor-plot: this body has no beam skeleton, hence no anchors; leave them out");
  for (const int a : options.plotted_anchors)
    if (a < 1 || static_cast<std::size_t>(a) > count)
      throw std::runtime_error(fmt::format("--plotted-anchors: {}; this body has anchors 1 to {}", a, count));
}

void fill(Json& json, const PressOptions& options, const Collected& all, const RunVerdict& verdict) {
  json.update({{"scene", options.scene},
               {"poses", all.rows},
               {"force_max_N", all.force_max_N},
               {"depth_max_m", all.depth_max_m},
               {"tick_instructions_max", all.instructions_max >= 0 ? Json(all.instructions_max) : Json(nullptr)},
               {"status", Json::array()},
               {"faults", faults_json(all.fault)},
               {"verdicts", verdicts_json({verdict})},
               {"files", {options.out}}});
  for (const BitText& bit : status_bit_texts()) {
    const Collected::Seen& seen = all.status[bit.bit];
    if (seen.ticks == 0) continue;
    json["status"].push_back(bit_json(bit));
    json["status"].back().update({{"ticks", seen.ticks}, {"first_s", seen.first_s}});
  }
  for (const std::string* file : {&options.vtu, &options.plot, &options.png, &options.anchors, &options.anchor_plot})
    if (!file->empty()) json["files"].push_back(*file);
}

int run_press(const PressOptions& options, Json& json) {
  const SceneModel scene(options.scene, options.overlays);
  const Model& model = scene.model();
  check_anchors(options, model);
  std::vector<TimedPose> poses = poses_of(options, scene);
  std::vector<TimedJoints> scripted;
  for (const TimedPose& pose : poses) scripted.push_back({pose.time_s, pose.joints});
  const JointScript joints(options.joints, model, std::move(scripted));
  for (TimedPose& pose : poses)
    if (!joints.empty()) pose.joints = joints.at(pose.time_s);
  ForceCsv csv(options.out);
  std::optional<VtuSeries> vtu;
  if (!options.vtu.empty()) vtu.emplace(options.vtu);
  InstructionCounter counter;
  if (!counter.available()) {
    fmt::print(stderr,
               "note: this kernel does not count instructions for us (perf_event_open: "
               "see /proc/sys/kernel/perf_event_paranoid); that column stays empty\n");
  }
  Collected all;
  const PressProgress progress(poses.size());
  const StatePtr state = make_state(model);
  const bool wants_anchors = !options.anchors.empty() || !options.anchor_plot.empty();
  press(model, poses, drive_of(options, scene), *state, &counter,
        [&](const PressRow& row, const State& now, const Scratch&) {
          all.add(row, now);
          csv.add(row);
          if (wants_anchors) all.add_anchors(sample_anchors(model, now, row.time_s, row.record.output.penetration_m));
          if (vtu && (all.rows - 1) % static_cast<std::uint64_t>(options.every) == 0)
            vtu->add(model, now, row.record, row.time_s);
          progress.at(all.rows);
        });
  csv.finish();
  if (vtu) vtu->finish();
  print_summary(all, options);
  write_pictures(options, model, all);
  write_anchors(options, model, all);
  const auto bit = static_cast<std::size_t>(std::countr_zero(Status::kNotConverged));
  const RunVerdict verdict = judge_unconverged(all.status[bit].ticks, all.rows, options.limits);
  fill(json, options, all, verdict);
  fmt::print("{}", verdict_text({verdict}));
  if (all.fault != 0) return kExitFault;
  return verdict.ok() ? kExitOk : kExitFailed;
}

}  // namespace

void add_press_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<PressOptions>();
  CLI::App* command = app.add_subcommand("press", "Move the tool through given poses and write the forces, no device");
  command->add_option("SCENE", options->scene, "scene (.toml) or image (.pal)")->required();
  add_overlay_options(*command, options->overlays);
  command
      ->add_option(
          "--path", options->path,
          "tool poses (CSV), or `demo`: the motion the scene scripts for its hand; where it scripts none, and of an "
          "image, onto the highest point")
      ->capture_default_str();
  command->add_option("--out", options->out, "table to write (CSV)")->capture_default_str();
  command->add_option("--vtu", options->vtu, "write deformed surfaces for ParaView into this folder");
  command->add_option("--every", options->every, "with --vtu: write only every Nth pose")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000000));
  command->add_option("--png", options->png, "draw the deformed body at the largest force (.png)")
      ->check(ends_in({".png"}));
  command->add_option("--plot", options->plot, "draw the force history (.svg or .png)")
      ->check(ends_in({".svg", ".png"}));
  command->add_option("--anchors", options->anchors, "write the forces and stresses at the skeleton's anchors (CSV)");
  command->add_option("--anchor-plot", options->anchor_plot, "draw the anchors' forces against depth (.svg or .png)")
      ->check(ends_in({".svg", ".png"}));
  command
      ->add_option("--plotted-anchors", options->plotted_anchors,
                   "anchors in that plot, as 1,2,3; default: the eight that carry most")
      ->delimiter(',');
  command
      ->add_option("--hand", options->hand_N_per_m,
                   "stiffness (N/m) of a hand that pulls the tool towards the poses; 0: the tool is at the poses; "
                   "default: 0, or the scene's hand with `--path demo`")
      ->check(number_in(0, 1e6));
  command->add_flag("--resample", options->resample, "interpolate the poses by their time_s to one per tick period");
  add_joint_options(*command, options->joints);
  add_allow_option(*command, options->limits, {"unconverged"});
  command->footer(
      "One pose is one tick, friction history included. Columns of both tables: docs/press.md.\n"
      "Examples:\n"
      "  palpate press config/scenes/ellipsoid_mallet.toml --path demo --out forces.csv --png press.png\n"
      "  palpate press mallet.pal --path poses.csv --out forces.csv --vtu surface --every 10\n"
      "  palpate press config/scenes/tools_on_layer.toml --with config/scenes/tools/flat_3_2.toml --plot flat.svg\n"
      "  palpate press config/scenes/grasp_cylinder_5.toml --close 1,0.8,0,0,0 --png pinch.png");
  add_json_flag(*command, options->json);
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "press", [&](Json& json) { return run_press(*options, json); });
  });
}

}  // namespace palpate
