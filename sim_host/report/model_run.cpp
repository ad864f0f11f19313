#include "sim_host/report/model_run.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <exception>

#include "config/bake/compile.h"
#include "config/scene/child_program.h"
#include "rt_core/image.h"
#include "rt_core/status.h"
#include "sim_host/bake/image_file.h"
#include "sim_host/press/press.h"
#include "sim_host/tick_memory.h"

namespace palpate {

namespace {

constexpr double kApproach_m = 2e-4;  // above the surface, where the path begins
constexpr double kSlide_m = 3e-3;

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Down to the depth, back to half of it and along the surface.
struct ReportPath {
  std::vector<TimedPose> pose;
  std::vector<double> depth_m;
  std::size_t slide_from = 0, press_to = 0;  // the press is [0, press_to), the slide [slide_from, end)
};

ReportPath path_of(const PressPlace& press) {
  ReportPath path;
  const auto add = [&](double depth, Vec3 aside) {
    TimedPose pose;
    pose.time_s = 1e-3 * static_cast<double>(path.pose.size());
    pose.tool_w.position_m = press.place_m + (press.radius_m - depth) * press.normal + aside;
    path.pose.push_back(pose);
    path.depth_m.push_back(depth);
  };
  const auto steps_over = [](double length) { return static_cast<int>(std::ceil(length / kReportStep_m)); };
  const int down = steps_over(press.depth_m + kApproach_m);
  for (int k = 0; k <= down; ++k) add(-kApproach_m + (press.depth_m + kApproach_m) * k / down, {});
  path.press_to = path.pose.size();
  const int up = steps_over(0.5 * press.depth_m);
  for (int k = 1; k <= up; ++k) add(press.depth_m * (1 - 0.5 * k / up), {});
  path.slide_from = path.pose.size();
  const Vec3 across = std::abs(press.normal.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  const Vec3 along = cross(press.normal, across);
  const int aside = steps_over(kSlide_m);
  for (int k = 1; k <= aside; ++k) add(0.5 * press.depth_m, (kSlide_m * k / aside / norm(along)) * along);
  return path;
}

// Everything but times: the same on every run. `surface`: at the end of the press.
void play(const Model& model, const ReportPath& path, const ReferenceSurface& surface, Vec3 normal, ModelRun& run) {
  std::vector<Vec3> slide;
  std::size_t i = 0;
  double sum = 0;
  const StatePtr state = make_state(model);
  press(model, path.pose, {}, *state, nullptr, [&](const PressRow& row, const State& now, const Scratch&) {
    const Vec3 force = row.record.output.contact_w.force_N;
    if (i + 1 == path.press_to && !surface.place.empty()) run.surface = surface_error(model, now, surface, normal);
    if (i < path.press_to && path.depth_m[i] >= 0) {
      run.path.x.push_back(path.depth_m[i]);
      run.path.force_N.push_back(force);
    }
    if (i >= path.slide_from) slide.push_back(force);
    if (i >= path.slide_from) sum += norm(force);
    run.unconverged += (row.record.output.status & Status::kNotConverged) != 0 ? 1 : 0;
    run.beyond_range += (row.record.output.status & Status::kDepthBeyondRange) != 0 ? 1 : 0;
    run.hash = row.record.state_hash;
    ++i;
  });
  run.ticks = static_cast<int>(i);
  run.step_N = largest_step_N(slide);
  run.slide_force_N = slide.empty() ? 0 : sum / static_cast<double>(slide.size());
}

void time_ticks(const Model& model, const ReportPath& path, int repeats, ModelRun& run) {
  std::vector<double> least(path.pose.size(), 1e30);
  std::vector<char> touches(path.pose.size());
  const StatePtr state = make_state(model);
  for (int r = 0; r < repeats; ++r) {
    std::size_t i = 0;
    press(model, path.pose, {}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
      least[i] = std::min(least[i], 1e-3 * static_cast<double>(row.compute_ns));
      touches[i] = row.record.output.contacts > 0;
      ++i;
    });
  }
  std::vector<double> us;
  for (std::size_t i = 0; i < least.size(); ++i)
    if (touches[i] != 0) us.push_back(least[i]);
  if (us.empty()) return;
  std::ranges::sort(us);
  const auto at = [&](double share) {
    return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  };
  run.p50_us = at(0.5);
  run.p999_us = at(0.999);
  run.max_us = us.back();
}

void measure(const ModelVariant& variant, const SceneDesc& stated, const PressPlace& press,
             const ReferenceCurve* reference, const ModelRunOptions& options, ModelRun& run) {
  const SceneDesc scene = scene_of(variant, stated, press);
  const double began = processor_s();
  const CompileResult baked = compile_scene(scene);
  run.bake_s = processor_s() - began;
  const TemporaryFolder folder("palpate-report");
  const std::string image_path = folder.file("case.pal");
  std::string failed;
  if (!save_image(image_path, baked.bytes, failed)) throw std::runtime_error(image_path + ": " + failed);
  const ImageFile image(image_path);
  const Model& model = image.model();
  run.image_bytes = baked.bytes.size();
  run.state_bytes = state_bytes(model);
  run.scratch_bytes = scratch_bytes(model);
  const ReportPath path = path_of(press);
  play(model, path, reference != nullptr ? reference->surface : ReferenceSurface{}, press.normal, run);
  if (reference != nullptr) {
    ForcePath truth{reference->depth_m, reference->force_N};
    run.error = curve_error(truth, run.path);
  }
  time_ticks(model, path, options.repeats, run);
  if (!options.count) return;
  run.count = count_ticks(image_path, path.pose);
}

}  // namespace

ModelRun run_model(const ModelVariant& variant, const SceneDesc& stated, const PressPlace& press,
                   const ReferenceCurve* reference, const ModelRunOptions& options) {
  ModelRun run;
  run.name = variant.name;
  run.family = variant.family;
  run.meaning = variant.meaning;
  try {
    measure(variant, stated, press, reference, options, run);
  } catch (const std::exception& error) {
    run.refused = error.what();
  }
  return run;
}

}  // namespace palpate
