#include "config/bake/elastic_choice.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "config/bake/elastic_check.h"
#include "config/bake/elastic_image.h"
#include "config/bake/surface_parts.h"
#include "config/parallel.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

constexpr std::int32_t kMostSoftTried = 8, kSoftUnlessStated = 4;
constexpr std::int32_t kPresses = 5;
// Amplitudes a little beyond the largest that a check press reached count as checked.
constexpr double kBeyond = 1.1;

std::vector<std::int32_t> soft_candidates(const ElasticDesc& elastic) {
  if (elastic.soft > 0) return {elastic.soft};
  return {1, 2, 4, kMostSoftTried};
}

// Presses that the scene asks for: stated, or some where the soft modes are left to the baker.
std::int32_t check_presses_of(const ElasticDesc& elastic) {
  return elastic.check_presses >= 0 ? elastic.check_presses : elastic.soft > 0 ? 0 : kPresses;
}
// Modes that a bake may want.
std::int32_t modes_of(const ElasticDesc& elastic) {
  const std::int32_t soft = elastic.soft > 0                ? elastic.soft
                            : check_presses_of(elastic) > 0 ? kMostSoftTried
                                                            : kSoftUnlessStated;
  return soft + elastic.linear;
}

struct Trial {
  std::int32_t soft = 0;
  double add_c_mpN = 0;
  double worst_error = 0, reach_rootJ = 0;
  double bias = 0;          // mean relative error
  double wanted_c_mpN = 0;  // more self compliance, which would take the bias away to first order
  std::vector<CheckedPress> press;
};

// Tries numbers of modes on one body, each with the self compliance that suits it.
class Chooser {
 public:
  Chooser(const SceneDesc& scene, const ElasticBake& bake, const std::vector<CheckPress>& presses, ImageContents& image)
      : scene_(scene), bake_(bake), presses_(presses), image_(image) {}

  // A patch that is not carried by the elements under it is wrong by the same compliance wherever elements are alike:
  // one number for the whole body, by a secant on the mean error.
  Trial best_of(std::int32_t soft) const {
    Trial plain = pressed(soft, 0);
    if (plain.worst_error <= scene_.elastic.check_error) return plain;
    const Trial second = pressed(soft, plain.wanted_c_mpN);
    const double slope = second.bias - plain.bias;
    if (!(std::abs(slope) > 1e-6)) return plain;
    const Trial third = pressed(soft, plain.wanted_c_mpN * clamp_to(-plain.bias / slope, 0.0, 3.0));
    return third.worst_error < plain.worst_error ? third : plain;
  }
  ElasticReport write(const Trial& trial, ElasticBake::Drawn drawn) const {
    return bake_.write(trial.soft, scene_.elastic.linear, trial.add_c_mpN, image_, drawn);
  }

 private:
  Trial pressed(std::int32_t soft, double add_c_mpN) const {
    Trial trial;
    trial.add_c_mpN = add_c_mpN;
    trial.soft = soft;
    trial.soft = write(trial, ElasticBake::Drawn::kLeftOut).soft;
    const ImageContents ball = with_ball(scene_, image_, presses_[0].radius_m);
    double count = 0;
    for (const CheckPress& press : presses_) {
      trial.press.push_back(press_baked(ball, press));
      const CheckedPress& last = trial.press.back();
      trial.worst_error = std::max(trial.worst_error, last.worst_error);
      trial.reach_rootJ = std::max(trial.reach_rootJ, last.reach_rootJ);
      if (press.depth_m.empty()) continue;
      count += 1;
      trial.bias += last.bias;
      trial.wanted_c_mpN += last.bias * press.depth_m.back() / press.reference_N.back();
    }
    trial.bias /= count;
    trial.wanted_c_mpN /= count;
    return trial;
  }

  const SceneDesc& scene_;
  const ElasticBake& bake_;
  const std::vector<CheckPress>& presses_;
  ImageContents& image_;
};

std::string per_cent(double share) { return number_text(std::round(1e3 * share) / 10) + " %"; }

// How many of those that are wanted: all that the scene states, or as many as do not take all day.
std::int32_t presses_made(const SceneDesc& scene, const ElasticBake& bake, std::vector<std::string>& warnings) {
  const std::int32_t wanted = check_presses_of(scene.elastic);
  if (scene.source.has("body.elastic.check_presses")) return wanted;
  const std::int32_t made = affordable_presses(wanted, bake.factor_multiplications());
  if (made < wanted)
    warnings.push_back(scene.source.where("body.elastic.check_presses") + ": " + std::to_string(made) +
                       " of the usual " + std::to_string(wanted) + " check presses are made, for each takes some " +
                       number_text(std::ceil(press_seconds(bake.factor_multiplications()) / 60)) +
                       " minutes with this body's " + std::to_string(bake.mesh().node_m.size()) +
                       " nodes; state their number to have them, or a larger body.fem.edge_mm");
  return made;
}

std::vector<CheckPress> solved_presses(const SceneDesc& scene, const ImageContents& image, const TetMesh& mesh,
                                       std::int32_t count, const BakeRun& run) {
  std::vector<CheckPress> presses = check_places(scene, image, mesh, count);
  std::mutex saying;
  double done = 0;
  if (run.progress) run.progress("check presses", 0);
  for_each_piece(presses.size(), run.jobs, [&](std::size_t i) {
    press_elements(scene, image, mesh, presses[i]);
    const std::lock_guard lock(saying);
    if (run.progress) run.progress("check presses", (done += 1) / static_cast<double>(presses.size()));
  });
  return presses;
}

ElasticReport::Check check_of(const CheckPress& press, const CheckedPress& checked) {
  ElasticReport::Check check;
  check.place_m = press.place_m;
  check.radius_m = press.radius_m;
  check.slides = press.slides;
  if (press.depth_m.empty()) return check;
  check.depth_m = press.depth_m.back();
  check.reference_N = press.reference_N.back();
  check.force_N = checked.force_N.back();
  check.worst_error = checked.worst_error;
  return check;
}

}  // namespace

ElasticReport bake_elastic_body(const SceneDesc& scene, ImageContents& image, std::vector<std::string>& warnings,
                                const BakeRun& run) {
  touch_by_parts(scene, image);
  const ElasticBake bake(scene, image, modes_of(scene.elastic), warnings, run.jobs);
  const std::int32_t linear = scene.elastic.linear;
  const auto unchecked = [&](ElasticBake::Drawn drawn) {
    return bake.write(scene.elastic.soft > 0 ? scene.elastic.soft : kSoftUnlessStated, linear, 0, image, drawn);
  };
  const std::int32_t count = presses_made(scene, bake, warnings);
  if (count == 0) return unchecked(ElasticBake::Drawn::kWritten);
  unchecked(ElasticBake::Drawn::kLeftOut);  // tells how fine the presses' elements are to be
  std::vector<CheckPress> presses = solved_presses(scene, image, bake.mesh(), count, run);
  const std::string where = scene.source.where("body.elastic.check_presses") + ": ";
  if (std::ranges::all_of(presses, [](const CheckPress& press) { return press.depth_m.empty(); })) {
    warnings.push_back(where +
                       "no place was found where a ball can press without the body going out from under it; nothing "
                       "is checked: hold more of the body, or use a smaller tool or contact.max_depth_mm");
    return unchecked(ElasticBake::Drawn::kWritten);
  }
  const Chooser chooser(scene, bake, presses, image);
  Trial best;
  for (const std::int32_t soft : soft_candidates(scene.elastic)) {
    if (soft <= best.soft) continue;  // a symmetric family was not parted
    Trial trial = chooser.best_of(soft);
    if (best.soft == 0 || trial.worst_error < best.worst_error) best = std::move(trial);
    if (best.worst_error <= scene.elastic.check_error) break;
  }
  ElasticReport report = chooser.write(best, ElasticBake::Drawn::kWritten);
  report.add_c_mpN = best.add_c_mpN;
  report.radius_rootJ = image.params.elastic_radius_rootJ =
      std::min(image.params.elastic_radius_rootJ, kBeyond * best.reach_rootJ);
  for (std::size_t i = 0; i < presses.size(); ++i) {
    report.check.push_back(check_of(presses[i], best.press[i]));
    if (!presses[i].depth_m.empty()) report.checked.push_back(checked_place(presses[i], best.press[i]));
  }
  report.press = presses;
  if (best.worst_error > scene.elastic.check_error)
    warnings.push_back(where + "the worst error is " + per_cent(best.worst_error) + " with " +
                       std::to_string(best.soft) + " soft modes, above body.elastic.check_error of " +
                       per_cent(scene.elastic.check_error) + (scene.elastic.soft > 0 ? "; let soft_modes be 0," : ";") +
                       " try a smaller body.fem.edge_mm or contact.max_depth_mm, or accept it");
  return report;
}

}  // namespace palpate
