// `palpate movie`: a recorded run as a moving picture.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>

#include "config/scene/progress.h"
#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/json_output.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/view/movie.h"

namespace palpate {

namespace {

struct FilmOptions {
  std::string recording, output = "movie.png", image, colour = "displacement";
  MovieOptions movie;
  bool json = false;
};

int run_movie(const FilmOptions& options, Json& json) {
  const MappedFile file(options.recording);
  const RecordingReader recording(file.bytes());
  const RecordedScene scene(recording, options.image);
  const Progress bar = isatty(STDERR_FILENO) != 0 ? progress_bar(stderr) : Progress{};
  MovieOptions wanted = options.movie;
  wanted.colour = surface_colours().at(options.colour);
  const MovieMade made = save_movie(options.output, file.bytes(), scene.model(), wanted, [&](double part) {
    if (bar) bar("frames", part);
  });
  json.update({{"recording", options.recording},
               {"files", {options.output}},
               {"frames", made.frames},
               {"from_s", made.from_s},
               {"to_s", made.to_s}});
  fmt::print("wrote   {} ({} frames, {:.2f} to {:.2f} s of the run)\n", options.output, made.frames, made.from_s,
             made.to_s);
  return kExitOk;
}

}  // namespace

void add_movie_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FilmOptions>();
  MovieOptions& movie = options->movie;
  CLI::App* command = app.add_subcommand("movie", "Make a moving picture (animated PNG) of a recorded run");
  command->add_option("RECORDING", options->recording, "recording (.plr)")->required();
  command->add_option("-o,--output", options->output, "moving picture to write (.png or .apng)")
      ->capture_default_str()
      ->check(ends_in({".png", ".apng"}));
  command
      ->add_option("--from", movie.from_s,
                   "where in the run it begins (2s, 500ms is 0.5); default: before the first touch")
      ->transform(duration_in(0, 1e9));
  command->add_option("--to", movie.to_s, "where it ends; default: after the last touch")
      ->transform(duration_in(0, 1e9));
  command->add_option("--speed", movie.speed, "1: as it was; 0.5: half as fast")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 100.0));
  command->add_option("--fps", movie.per_second, "frames a second")->capture_default_str()->check(CLI::Range(1, 60));
  command->add_option("--colour", options->colour, "displacement, pressure or stress, as of `palpate picture`")
      ->capture_default_str()
      ->check(CLI::IsMember({"displacement", "pressure", "stress"}));
  command->add_option("--image", options->image, "scene image, when it is no longer where the recording says");
  command->add_option("--width", movie.width, "pixels")->capture_default_str()->check(CLI::Range(200, 4000));
  command->add_option("--height", movie.height, "pixels")->capture_default_str()->check(CLI::Range(150, 4000));
  command->footer(
      "An animated PNG plays in every browser; other formats from it: ffmpeg -i movie.png movie.mp4\n"
      "Examples:\n"
      "  palpate movie run.plr -o press.png --speed 0.5\n"
      "  palpate movie run.plr --from 1.5s --to 4s --width 480 --height 360 -o slide.png");
  add_json_flag(*command, options->json);
  command->callback([options, &exit_code] {
    try {
      exit_code = run_with_json(options->json, "movie", [&](Json& json) { return run_movie(*options, json); });
    } catch (const RecordingError& error) {
      throw std::runtime_error(about_file(options->recording, error.what()));
    }
  });
}

}  // namespace palpate
