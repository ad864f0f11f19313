// `palpate picture`: draws the deformed body, and the force history, of a recorded run; or a scene at rest.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "rt_core/tick.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/json_output.h"
#include "sim_host/press/pose_csv.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/replay.h"
#include "sim_host/view/picture.h"
#include "sim_host/view/plot.h"

namespace palpate {

namespace {

struct DrawOptions {
  std::string source, output = "picture.png", image, plot, view, colour = "displacement";
  std::int64_t tick = -1;
  int width = 1200, height = 900;
  bool json = false;
};

// Whether a file starts like a recording.
bool is_recording(const MappedFile& file) {
  static constexpr char kMagic[] = "LPREC01";
  return file.bytes().size() >= sizeof kMagic && std::memcmp(file.bytes().data(), kMagic, sizeof kMagic) == 0;
}

struct History {
  std::vector<ForceSample> samples;
  std::uint64_t strongest_tick = 0;
  std::uint64_t first_tick = 0, last_tick = 0;
};

History read_history(const MappedFile& file) {
  RecordingReader recording(file.bytes());
  History history;
  TickRecord record;
  double strongest = -1;
  while (recording.next(record)) {
    const Output& output = record.output;
    // As in the viewer: what happens after the force was let go, when the hand falls into the body, is no press.
    const double force = output.mode == Mode::kForce ? norm(output.contact_w.force_N) : -0.5;
    if (history.samples.empty()) history.first_tick = record.tick;
    if (force > strongest) {
      strongest = force;
      history.strongest_tick = record.tick;
    }
    history.last_tick = record.tick;
    const double time_s = 1e-9 * static_cast<double>(recording.header().period_ns) * static_cast<double>(record.tick);
    history.samples.push_back({time_s, output.contact_w.force_N, output.penetration_m, output.regions});
  }
  if (history.samples.empty()) throw std::runtime_error("the recording holds no ticks");
  return history;
}

PictureOptions picture_of(const DrawOptions& options) {
  PictureOptions picture;
  picture.width = options.width;
  picture.height = options.height;
  picture.colour = surface_colours().at(options.colour);
  if (!options.view.empty()) picture.view = standard_views().at(options.view);
  return picture;
}

int draw_recording(const DrawOptions& options, const MappedFile& file, Json& json) {
  RecordingReader recording(file.bytes());
  const RecordedScene scene(recording, options.image);
  const History history = read_history(file);
  const std::uint64_t wanted = options.tick >= 0 ? static_cast<std::uint64_t>(options.tick) : history.strongest_tick;
  if (wanted < history.first_tick || wanted > history.last_tick) {
    throw std::runtime_error(
        fmt::format("--tick {}: the recording holds ticks {} to {}", wanted, history.first_tick, history.last_tick));
  }
  const StatePtr state = state_after(recording, scene.model(), wanted);
  PictureOptions picture = picture_of(options);
  picture.title = fmt::format("{}, tick {}", scene.model().name, wanted);
  save_picture(options.output, scene.model(), *state, picture);
  json["tick"] = wanted;
  fmt::print("wrote   {} (tick {})\n", options.output, wanted);
  if (!options.plot.empty()) {
    force_history_plot(history.samples, scene.model().name).save(options.plot);
    fmt::print("wrote   {}\n", options.plot);
  }
  return kExitOk;
}

int draw_scene(const DrawOptions& options) {
  if (options.tick >= 0 || !options.plot.empty()) throw std::runtime_error("--tick and --plot need a recording");
  const SceneModel scene(options.source);
  const StatePtr state = make_state(scene.model());
  if (scene.scene() && !scene.scene()->path.point.empty()) {
    Input input;
    input.drive = Drive::kTool;
    input.pose_w = scripted_poses(scene.scene()->path, scene.model().params.period_s).front().tool_w;
    const ScratchPtr scratch = make_scratch(scene.model());
    Output output;
    tick(scene.model(), *state, *scratch, input, output);  // a hand's joints go to where they begin
  }
  save_picture(options.output, scene.model(), *state, picture_of(options));
  fmt::print("wrote   {}\n", options.output);
  return kExitOk;
}

int run_picture(const DrawOptions& options, Json& json) {
  json.update({{"source", options.source}, {"files", {options.output}}});
  if (!options.plot.empty()) json["files"].push_back(options.plot);
  if (options.source.ends_with(".toml")) return draw_scene(options);
  const MappedFile file(options.source);
  return is_recording(file) ? draw_recording(options, file, json) : draw_scene(options);
}

}  // namespace

void add_picture_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DrawOptions>();
  CLI::App* command = app.add_subcommand("picture", "Draw the deformed body of a recorded run, or a scene at rest");
  command->add_option("SOURCE", options->source, "recording (.plr), scene (.toml) or image (.pal)")->required();
  command->add_option("-o,--output", options->output, "picture to write (.png)")
      ->capture_default_str()
      ->check(ends_in({".png"}));
  command->add_option("--tick", options->tick, "tick to draw; default: the one with the largest force")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--image", options->image, "scene image, when it is no longer where the recording says");
  command->add_option("--plot", options->plot, "also draw the force history (.svg or .png)")
      ->check(ends_in({".svg", ".png"}));
  command
      ->add_option("--view", options->view,
                   "oblique, front, back, left, right, top or bottom; default: from the side of the contacts")
      ->check(CLI::IsMember({"oblique", "front", "back", "left", "right", "top", "bottom"}));
  command
      ->add_option("--colour", options->colour,
                   "displacement, pressure (of the contacts) or stress (at the anchors of a beam skeleton); what the "
                   "scene's model does not solve is not drawn, and the legend says so")
      ->capture_default_str()
      ->check(CLI::IsMember({"displacement", "pressure", "stress"}));
  command->add_option("--width", options->width, "pixels")->capture_default_str()->check(CLI::Range(200, 4000));
  command->add_option("--height", options->height, "pixels")->capture_default_str()->check(CLI::Range(150, 4000));
  command->footer(
      "Examples:\n"
      "  palpate picture run.plr -o deformed.png --plot forces.svg\n"
      "  palpate picture run.plr --tick 2500 --view front -o front.png\n"
      "  palpate picture run.plr --colour pressure -o pressure.png\n"
      "  palpate picture config/scenes/heart_compass.toml -o scene.png");
  add_json_flag(*command, options->json);
  command->callback([options, &exit_code] {
    try {
      exit_code = run_with_json(options->json, "picture", [&](Json& json) { return run_picture(*options, json); });
    } catch (const RecordingError& error) {
      throw std::runtime_error(about_file(options->source, error.what()));
    }
  });
}

}  // namespace palpate
