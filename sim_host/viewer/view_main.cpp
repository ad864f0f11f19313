// palpate-view, started as `palpate view`: a window on a run, recorded or going on. A program of its own: neither the
// controller nor `palpate` links anything of graphics.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <filesystem>
#include <map>

#include "config/scene/child_program.h"
#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/exit_codes.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/run/run_summary.h"
#include "sim_host/run/verdict.h"
#include "sim_host/view/live_run.h"
#include "sim_host/viewer/viewer_app.h"

namespace palpate {
namespace {

struct ViewCommand {
  std::string source, image, size = "1600x1000", view, attach;
  double at_s = -1;
  bool motion = false, real_time = false;
  RunOptions run;
  ViewerOptions viewer;
};

void read_size(ViewCommand& command) {
  int used = 0, width = 0, height = 0;
  const int read = std::sscanf(command.size.c_str(), "%dx%d%n", &width, &height, &used);
  if (read != 2 || static_cast<std::size_t>(used) != command.size.size() || width < 320 || height < 240 ||
      width > 7680 || height > 4320)
    throw std::runtime_error("--size " + command.size + ": expected WIDTHxHEIGHT, 320x240 to 7680x4320");
  command.viewer.width = width;
  command.viewer.height = height;
}

void show_recording(const ViewCommand& command) {
  const MappedFile file(command.source);
  RecordingReader recording(file.bytes());
  const RecordedScene scene(recording, command.image);
  const double period_s = 1e-9 * static_cast<double>(recording.header().period_ns);
  RunTrack track(period_s);
  TickRecord record;
  while (recording.next(record)) track.append(record);
  if (!recording.error().empty()) fmt::print(stderr, "palpate: {}\n", recording.error());
  if (track.size() == 0) throw std::runtime_error(command.source + ": the recording holds no ticks");
  const StatePtr initial = recording.state_known() ? recording.initial_state(scene.model()) : make_state(scene.model());
  ViewerRun run;
  run.model = &scene.model();
  run.track = &track;
  run.initial = initial.get();
  if (!recording.state_known())
    run.notice = [] {
      return std::string("a slice of a run: its beginning is not known, the shape is near the true one");
    };
  ViewerOptions options = command.viewer;
  options.title = scene.model().name;
  show_run(run, options);
}

// One that was finished; then it is a recording that no file holds.
void show_finished(StartedRun& live, ViewerOptions options) {
  live.result();
  ViewerRun run;
  run.model = &live.model();
  run.track = &live.track();
  run.initial = &live.initial();
  options.title = live.model().name;
  show_run(run, options);
}

void show_live(LiveRun& live, ViewerOptions options, StartedRun* started) {
  ViewerRun run;
  run.model = &live.model();
  run.track = &live.track();
  run.initial = &live.initial();
  run.goes_on = [&live] { return live.goes_on(); };
  run.notice = [&live] { return live.notice(); };
  run.steering = live.steering();
  // Ctrl-C ends the run in order; the window goes with it.
  if (started != nullptr) run.closes = [&] { return !live.goes_on() && started->result().interrupted; };
  options.title = live.model().name;
  show_run(run, options);
}

// A scene: the controller with the simulated device, its hand at the mouse; or with a real device.
int show_scene(ViewCommand& command) {
  const TemporaryFolder folder("palpate-view");
  RunOptions& options = command.run;
  const bool picture = !command.viewer.screenshot.empty();
  const bool simulated = options.device == "auto";
  options.scene = command.source;
  options.image = folder.file("scene.pal");
  options.quiet = true;
  options.duration_s = picture ? (command.at_s >= 0 ? command.at_s + 0.01 : 10) : 86'400;
  options.pace = !picture;
  if (simulated && command.real_time) options.device = "loopback";
  StartedRun live(options, simulated && !command.motion && !picture);
  if (picture) {
    show_finished(live, command.viewer);
    return kExitOk;
  }
  show_live(live, command.viewer, &live);
  live.stop();
  const RunResult& result = live.result();
  fmt::print("{}", summary_text(result.summary, result.lost));
  if (!options.record.empty() && result.recorder_error.empty()) fmt::print("record  {}\n", options.record);
  return exit_code_of(result, {});
}

int run(ViewCommand& command) {
  read_size(command);
  ViewerOptions& viewer = command.viewer;
  if (command.at_s >= 0) viewer.at_s = command.at_s;
  if (!command.view.empty()) {
    const std::map<std::string, StandardView> views{
        {"oblique", StandardView::kOblique}, {"front", StandardView::kFront}, {"back", StandardView::kBack},
        {"left", StandardView::kLeft},       {"right", StandardView::kRight}, {"top", StandardView::kTop},
        {"bottom", StandardView::kBottom}};
    viewer.view = views.at(command.view);
    viewer.default_view = false;
  }
  if (!command.attach.empty()) {
    if (!viewer.screenshot.empty())
      throw std::runtime_error("--screenshot: of a recording or a scene, not with --attach");
    const std::unique_ptr<LiveRun> live = attach_to(command.attach);
    show_live(*live, viewer, nullptr);
    return kExitOk;
  }
  if (command.source.empty())
    throw std::runtime_error("name a recording (.plr), a scene (.toml), or --attach to a run");
  if (command.source.ends_with(".toml") || command.source.ends_with(".pal")) return show_scene(command);
  try {
    show_recording(command);
  } catch (const RecordingError& error) {
    throw std::runtime_error(about_file(command.source, error.what()));
  }
  return kExitOk;
}

void add_options(CLI::App& app, ViewCommand& command) {
  app.add_option("SOURCE", command.source, "recording (.plr), or a scene (.toml, .pal) to feel with the mouse");
  app.add_option("--attach", command.attach,
                 "watch a run that goes on: the process id of its palpate-rt, or the recording it is writing");
  app.add_flag("--motion", command.motion, "of a scene: its own motion, until the tool is dragged");
  app.add_flag(
      "--real-time", command.real_time,
      "the simulated device in real time; default: in virtual time that keeps up with the clock, so that a busy "
      "machine misses nothing");
  app.add_option("--device", command.run.device, "of a scene: can:IFACE or usb:/dev/hidrawN instead of the mouse")
      ->capture_default_str();
  app.add_option("--profile", command.run.profile, "what that device can do (config/devices/*.toml)");
  app.add_option("--record", command.run.record, "of a scene: recording to write; default: none");
  app.add_option("--at", command.at_s, "seconds of the run; default: at the largest force")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--view", command.view, "oblique, front, back, left, right, top or bottom; default: as still pictures")
      ->check(CLI::IsMember({"oblique", "front", "back", "left", "right", "top", "bottom"}));
  app.add_option("--screenshot", command.viewer.screenshot, "write this PNG and leave; no window is shown")
      ->check(ends_in({".png"}));
  app.add_option("--size", command.size, "pixels, WIDTHxHEIGHT")->capture_default_str();
  app.add_option("--image", command.image, "scene image, when it is no longer where the recording says");
  app.add_option("--triangles", command.viewer.most_triangles, "bodies are refined for drawing up to so many")
      ->capture_default_str()
      ->check(CLI::Range(0, 4'000'000));
  app.add_flag(
      "--no-panel", [&command](std::int64_t) { command.viewer.panel = false; }, "the scene and the time alone");
  app.add_flag("--stats", command.viewer.stats, "after five seconds: frame times and memory, and leave");
  app.footer(
      "Examples:\n"
      "  palpate view config/scenes/heart_compass.toml       drag the tool: the mouse is the device\n"
      "  palpate view run.plr                                 scrub through a recording\n"
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
    return palpate::run(command);
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
