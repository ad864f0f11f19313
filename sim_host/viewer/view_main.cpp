// palpate-view, started as `palpate view`: a window on a run, recorded or going on. A program of its own: neither the
// controller nor `palpate` links anything of graphics.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "config/scene/child_program.h"
#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/exit_codes.h"
#include "sim_host/json_output.h"
#include "sim_host/overlay_options.h"
#include "sim_host/run/run_json.h"
#include "sim_host/view/live_run.h"
#include "sim_host/view/opened_recording.h"
#include "sim_host/viewer/viewer_app.h"

namespace palpate {
namespace {

struct ViewCommand {
  std::vector<std::string> source, also;
  std::string image, size = "1600x1000", view, attach, align = "time", script, colour = "displacement";
  double at_s = -1;
  bool motion = false, real_time = false, json = false;
  RunOptions run;
  ViewerOptions viewer;
};

bool is_scene(const std::string& file) { return file.ends_with(".toml") || file.ends_with(".pal"); }

// What belongs to a scene that is baked here is none of a recording's, which has its own.
void check_scene_options(const ViewCommand& command) {
  const SceneOverlays& overlays = command.run.overlays;
  const char* option = !overlays.file.empty()      ? "--with"
                       : !overlays.setting.empty() ? "--set"
                       : !command.run.path.empty() ? "--path"
                       : !command.also.empty()     ? "--also"
                                                   : nullptr;
  if (option != nullptr && (command.source.size() != 1 || !is_scene(command.source.front())))
    throw std::runtime_error(
        fmt::format("{}: of one scene, which is felt with the mouse; record it (palpate run {} ...)", option, option));
}

void read_size(ViewCommand& command) {
  int used = 0, width = 0, height = 0;
  const int read = std::sscanf(command.size.c_str(), "%dx%d%n", &width, &height, &used);
  if (read != 2 || static_cast<std::size_t>(used) != command.size.size() || width < 320 || height < 240 ||
      width > 7680 || height > 4320)
    throw std::runtime_error("--size " + command.size + ": expected WIDTHxHEIGHT, 320x240 to 7680x4320");
  command.viewer.width = width;
  command.viewer.height = height;
}

ViewerRun run_of(const OpenedRecording& recording) {
  ViewerRun run;
  run.title = recording.model().name;
  run.model = &recording.model();
  run.track = &recording.track();
  run.initial = &recording.initial();
  if (!recording.damage().empty()) fmt::print(stderr, "palpate: {}: {}\n", recording.path(), recording.damage());
  if (!recording.state_known())
    run.notice = [] {
      return std::string("a slice of a run: its beginning is not known, the shape is near the true one");
    };
  return run;
}

void show_recording(const ViewCommand& command) {
  const OpenedRecording recording(command.source.front(), command.image);
  show_run(run_of(recording), command.viewer);
}

// Two of them, told apart by their files.
void show_two(const ViewCommand& command) {
  for (const std::string& file : command.source)
    if (is_scene(file))
      throw std::runtime_error(file +
                               ": is a scene; beside one another stand recordings: record it first (palpate run " +
                               file + " --record FILE.plr)");
  if (!command.image.empty())
    throw std::runtime_error("--image: for one recording; of two, each holds its scene or names it");
  const OpenedRecording a(command.source[0], ""), b(command.source[1], "");
  const std::array<std::string, 2> names{a.path(), b.path()};
  check_sizes(a.model(), b.model(), names);
  const Comparison comparison(a.track(), b.track(), command.align == "touch" ? Alignment::kTouch : Alignment::kTime,
                              names);
  std::array<ViewerRun, Comparison::kRuns> runs{run_of(a), run_of(b)};
  for (std::size_t i = 0; i < runs.size(); ++i)
    runs[i].title = fmt::format("{} ({})", std::filesystem::path(names[i]).filename().string(), runs[i].title);
  show_comparison(runs, comparison, command.viewer);
}

// One that was finished; then it is a recording that no file holds.
void show_finished(StartedRun& live, const ViewerOptions& options) {
  live.result();
  ViewerRun run;
  run.model = &live.model();
  run.track = &live.track();
  run.initial = &live.initial();
  run.title = live.model().name;
  show_run(run, options);
}

// `started`: the same when it was started here, and what its list of scenes is to have besides.
void show_live(LiveRun& live, const ViewerOptions& options, StartedRun* started,
               const std::vector<std::string>& also = {}) {
  ViewerRun run;
  if (started != nullptr) {
    run.newest = [started] { return started->scene(); };
    run.show(run.newest());
    run.change = &started->change();
    run.also = also;
  } else {
    run.model = &live.model();
    run.track = &live.track();
    run.initial = &live.initial();
    run.title = live.model().name;
  }
  run.goes_on = [&live] { return live.goes_on(); };
  run.notice = [&live] { return live.notice(); };
  run.steering = live.steering();
  // Ctrl-C ends the run in order; the window goes with it.
  if (started != nullptr) run.closes = [&] { return !live.goes_on() && started->result().interrupted; };
  show_run(run, options);
}

// A scene: the controller with the simulated device, its hand at the mouse; or with a real device.
int show_scene(ViewCommand& command, Json& json) {
  const TemporaryFolder folder("palpate-view");
  RunOptions& options = command.run;
  const bool picture = !command.viewer.screenshot.empty();
  const bool simulated = options.device == "auto";
  options.scene = command.source.front();
  options.image = folder.file("scene.pal");
  options.quiet = true;
  // A recording of a day would ask for a disk of 84 GB.
  const double longest_s = options.record.empty() ? 86'400 : 3'600;
  options.duration_s = picture ? (command.at_s >= 0 ? command.at_s + 0.01 : 10) : longest_s;
  options.pace = !picture;
  if (simulated && command.real_time) options.device = "loopback";
  StartedRun live(options, simulated && !command.motion && !picture);
  if (picture) {
    show_finished(live, command.viewer);
    return kExitOk;
  }
  show_live(live, command.viewer, &live, command.also);
  live.stop();
  const RunResult& result = live.result();
  json["run"] = summary_json(result.summary, result.lost);
  fmt::print("{}", summary_text(result.summary, result.lost));
  if (!options.record.empty() && result.recorder_error.empty()) {
    fmt::print("record  {}\n", options.record);
    for (const std::string& later : result.later_recordings) fmt::print("record  {}\n", later);
  }
  return exit_code_of(result, {});
}

int run(ViewCommand& command, Json& json) {
  read_size(command);
  ViewerOptions& viewer = command.viewer;
  if (!command.attach.empty()) json["source"] = command.attach;
  if (!command.source.empty()) json["source"] = command.source.front();
  if (command.source.size() > 1) json["beside"] = command.source[1];
  if (!viewer.screenshot.empty()) json["files"] = {viewer.screenshot};
  check_scene_options(command);
  if (command.at_s >= 0) viewer.at_s = command.at_s;
  if (!command.view.empty()) {
    viewer.view = standard_views().at(command.view);
    viewer.default_view = false;
  }
  viewer.colour = surface_colours().at(command.colour);
  if (!command.script.empty()) viewer.script = read_view_script(command.script);
  if (!viewer.script.empty() && !viewer.screenshot.empty())
    throw std::runtime_error("--script: writes its own pictures, without --screenshot");
  if (!command.attach.empty()) {
    if (!command.source.empty()) throw std::runtime_error("--attach: watches one run; without " + command.source[0]);
    if (!viewer.screenshot.empty())
      throw std::runtime_error("--screenshot: of a recording or a scene, not with --attach");
    const std::unique_ptr<LiveRun> live = attach_to(command.attach);
    show_live(*live, viewer, nullptr);
    return kExitOk;
  }
  if (command.source.empty())
    throw std::runtime_error("name a recording (.plr), a scene (.toml), or --attach to a run");
  const std::string& source = command.source.front();
  if (command.source.size() > 1)
    show_two(command);
  else if (is_scene(source))
    return show_scene(command, json);
  else
    show_recording(command);
  return kExitOk;
}

void add_options(CLI::App& app, ViewCommand& command) {
  app.add_option("SOURCE", command.source,
                 "recording (.plr), two recordings to compare, or a scene (.toml, .pal) to feel with the mouse")
      ->expected(0, 2);
  app.add_option("--align", command.align, "of two recordings: by time, or by the first touch of each")
      ->capture_default_str()
      ->check(CLI::IsMember({"time", "touch"}));
  app.add_option("--attach", command.attach,
                 "watch a run that goes on: the process id of its palpate-rt, or the recording it is writing");
  add_overlay_options(app, command.run.overlays);
  app.add_option("--path", command.run.path, "of a scene: the motion of its hand (CSV), instead of its own");
  app.add_option(
         "--also", command.also,
         "of a scene: another scene or image that the list (key L) offers, besides those of the scene's folder; "
         "repeatable")
      ->check(ends_in({".toml", ".pal"}))
      ->check(CLI::ExistingFile);
  app.add_flag("--motion", command.motion, "of a scene: its own motion, until the tool is dragged");
  app.add_flag(
      "--real-time", command.real_time,
      "the simulated device in real time; default: in virtual time that keeps up with the clock, so that a busy "
      "machine misses nothing");
  app.add_option("--device", command.run.device, "of a scene: can:IFACE or usb:/dev/hidrawN instead of the mouse")
      ->capture_default_str();
  app.add_option("--profile", command.run.profile, "what that device can do (config/devices/*.toml)");
  app.add_option("--record", command.run.record, "of a scene: recording to write, of an hour at most; default: none");
  app.add_option("--at", command.at_s,
                 "when in the run (2.5, 2.5s, 1m), of two aligned by touch after it; default: at the largest force")
      ->transform(duration_in(0, 1e9));
  app.add_option("--view", command.view, "oblique, front, back, left, right, top or bottom; default: as still pictures")
      ->check(CLI::IsMember({"oblique", "front", "back", "left", "right", "top", "bottom"}));
  app.add_option("--colour", command.colour, "of the body: displacement, pressure or stress (key K)")
      ->capture_default_str()
      ->check(CLI::IsMember({"displacement", "pressure", "stress"}));
  app.add_option("--screenshot", command.viewer.screenshot, "write this PNG and leave; no window is shown")
      ->check(ends_in({".png"}));
  app.add_option("--script", command.script, "do the steps of this file, one a line, and leave; steps below");
  app.add_option("--size", command.size, "pixels, WIDTHxHEIGHT")->capture_default_str();
  app.add_option("--image", command.image, "scene image, when it is no longer where the recording says");
  app.add_option("--triangles", command.viewer.most_triangles, "bodies are refined for drawing up to so many")
      ->capture_default_str()
      ->check(CLI::Range(0, 4'000'000));
  app.add_flag(
      "--no-panel", [&command](std::int64_t) { command.viewer.panel = false; }, "the scene and the time alone");
  app.add_flag("--stats", command.viewer.stats, "after five seconds: frame times and memory, and leave");
  add_json_flag(app, command.json);
  app.footer("Steps of a script (places are the handle's; # begins a remark):\n" + view_script_words() +
             "Examples:\n"
             "  palpate view config/scenes/heart_compass.toml       drag the tool: the mouse is the device\n"
             "  palpate view config/scenes/grasp_cylinder_5.toml --with config/scenes/bodies/hollow_cylinder.toml\n"
             "  palpate view run.plr                                 scrub through a recording\n"
             "  palpate view before.plr after.plr --align touch      two recordings beside one another\n"
             "  palpate view --attach $(pgrep palpate-rt)            watch the run of another terminal\n"
             "  xvfb-run -a palpate view run.plr --at 2.5 --size 1200x800 --screenshot press.png");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  CLI::App app{"Look at a run: turn it, scrub through it, take pictures of it.", "palpate view"};
  palpate::ViewCommand command;
  command.run.record.clear();
  palpate::add_options(app, command);
  try {
    app.parse(argc, argv);
    return palpate::run_with_json(command.json, "view", [&](palpate::Json& json) { return run(command, json); });
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? palpate::kExitOk : palpate::kExitUsage;
  } catch (const palpate::ExitError& error) {
    std::fprintf(stderr, "palpate: %s\n", error.what());
    return error.code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate: %s\n", error.what());
    return palpate::kExitUsage;
  }
}
