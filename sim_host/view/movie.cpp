#include "sim_host/view/movie.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim_host/record/replay.h"
#include "sim_host/view/apng_file.h"
#include "sim_host/view/deformed_surface.h"
#include "sim_host/view/picture.h"
#include "sim_host/view/run_track.h"

namespace palpate {

namespace {

constexpr double kAround_s = 0.25;  // shown before the first touch and after the last
// Of the drawn body: half a second a frame instead of two, and at these sizes the same picture.
constexpr std::size_t kMostTriangles = 60'000;

// What is known of a run without ticking it again.
struct RunOutline {
  std::uint64_t first = 0, last = 0;              // ticks there are
  std::uint64_t first_touch = 0, last_touch = 0;  // none: last_touch < first_touch
  std::uint64_t strongest = 0;
  double largest_N = 0;  // of a region
};

RunOutline outline_of(RecordingReader& recording) {
  RunOutline outline;
  outline.first_touch = ~std::uint64_t{0};
  TickRecord record;
  bool any = false;
  double strongest_N = -1;
  while (recording.next(record)) {
    const TrackTick at = track_tick(record);
    if (!any) outline.first = at.tick;
    any = true;
    outline.last = at.tick;
    if (at.regions > 0) {
      outline.first_touch = std::min(outline.first_touch, at.tick);
      outline.last_touch = at.tick;
    }
    const bool rendering = at.mode == Mode::kForce;  // as RunTrack
    if (rendering) outline.largest_N = std::max(outline.largest_N, at.largest_region_N);
    if (const double force_N = rendering ? norm(at.contact_N) : -0.5; force_N > strongest_N) {
      strongest_N = force_N;
      outline.strongest = at.tick;
    }
  }
  if (!any) throw std::runtime_error("the recording holds no ticks");
  return outline;
}

// First tick and ticks from frame to frame; the count is in MovieMade.
struct MovieTicks {
  double first = 0, step = 1;
  std::uint64_t of(int frame) const { return static_cast<std::uint64_t>(std::llround(first + step * frame)); }
};

MovieTicks choose_ticks(const RunOutline& run, double period_s, const MovieOptions& options, MovieMade& made) {
  const bool touches = run.last_touch >= run.first_touch;
  const double first_s = period_s * static_cast<double>(run.first), last_s = period_s * static_cast<double>(run.last);
  made.from_s = options.from_s >= 0 ? options.from_s
                : touches           ? period_s * static_cast<double>(run.first_touch) - kAround_s
                                    : first_s;
  made.to_s = options.to_s >= 0 ? options.to_s
              : touches         ? period_s * static_cast<double>(run.last_touch) + kAround_s
                                : last_s;
  made.from_s = std::max(made.from_s, first_s);
  made.to_s = std::min(made.to_s, last_s);
  if (!(made.to_s > made.from_s))
    throw std::runtime_error(fmt::format("nothing to show from {:g} to {:g} s: the recording holds {:g} to {:g} s",
                                         options.from_s, options.to_s, first_s, last_s));
  const double frames = std::floor((made.to_s - made.from_s) / options.speed * options.per_second) + 1;
  if (frames > kMostFrames)
    throw std::runtime_error(
        fmt::format("{:.0f} frames, more than {}: show less of it, faster, or with fewer frames "
                    "a second (--from, --to, --speed, --fps)",
                    frames, kMostFrames));
  made.frames = static_cast<int>(frames);
  return {made.from_s / period_s, options.speed / options.per_second / period_s};
}

// One scale and one place for all frames: those of the strongest tick.
void look_at(const Model& model, const State& state, const DeformedSurface& surface, PictureOptions& picture) {
  picture.colour_max = largest_value(surface, anchors_of(model, state), picture.colour);
  std::vector<Vec3> arrow_tips;
  for (const Region& region : state.region)
    if (region.id != 0)
      arrow_tips.push_back(region.centre_w +
                           (0.45 * model.params.surface_size_m) * unit_or(region.wrench_w.force_N, {}));
  picture.camera = default_camera(model, state, arrow_tips, double(picture.width) / picture.height);
}

}  // namespace

MovieMade save_movie(const std::string& path, std::span<const std::byte> bytes, const Model& model,
                     const MovieOptions& options, const std::function<void(double)>& progress) {
  RecordingReader first_pass(bytes);
  const RunOutline run = outline_of(first_pass);
  const double period_s = 1e-9 * static_cast<double>(first_pass.header().period_ns);
  MovieMade made;
  const MovieTicks ticks = choose_ticks(run, period_s, options, made);
  const RefinedBody body(model, kMostTriangles);
  PictureOptions picture;
  picture.colour = options.colour;
  picture.width = options.width;
  picture.height = options.height;
  picture.force_max_N = run.largest_N;
  RecordingReader second_pass(bytes);
  const StatePtr strongest = state_after(second_pass, model, run.strongest);
  look_at(model, *strongest, body.shape(*strongest), picture);

  ApngFile file(path, options.width, options.height, made.frames, options.per_second);
  RecordingReader third_pass(bytes);
  int frame = 0;
  for_each_state(third_pass, model, [&](const TickRecord& record, const State& state) {
    for (; frame < made.frames && std::min(ticks.of(frame), run.last) == record.tick; ++frame) {
      picture.title = fmt::format("{}, {:.2f} s", model.name, period_s * static_cast<double>(record.tick));
      file.add(render_scene(model, state, body.shape(state), picture).bytes());
      if (progress) progress(double(frame + 1) / made.frames);
    }
    return frame < made.frames;
  });
  file.finish();
  return made;
}

}  // namespace palpate
