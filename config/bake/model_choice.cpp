#include "config/bake/model_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "config/bake/certificate_writer.h"
#include "config/bake/opened_image.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"
#include "rt_core/image.h"
#include "rt_core/stage_cost.h"

namespace palpate {

namespace {

// Elements shorter by this where the stated ones do not meet the target: three times as many.
constexpr double kFiner = 0.7;

void tip(SceneDesc& scene) {
  scene.contact.backend = Backend::kResponse;
  scene.contact.law = ContactLaw::kTool;
  scene.fem = {};
  scene.elastic = {};
  // Its elements and modes are what the presses are made of: no mistake of the scene's.
  std::erase_if(scene.source.line, [](const auto& entry) {
    return entry.first.starts_with("body.fem") || entry.first.starts_with("body.elastic");
  });
}
void tip_series(SceneDesc& scene) {
  tip(scene);
  scene.series.c0_m_per_N = scene.series.c1_m_per_N2 = kAuto;
}
constexpr std::array kCheaper = {
    ModelCandidate{"tip", "whole tips on a half space of E and nu (contact.law = \"tool\")",
                   "bending, supports and edges of the body", tip},
    ModelCandidate{"tip_series",
                   "whole tips in series with the body's far field under one press (contact.series, auto)",
                   "how the far field differs from place to place", tip_series},
};
constexpr const char* kElasticLeavesOut =
    "errors of the elements away from the presses, two tips at once, friction along the surface";

std::string per_cent(double share) { return number_text(std::round(1e3 * share) / 10) + " %"; }

// The scene with the check presses' ball as its only tool, without friction.
SceneDesc with_ball_alone(const SceneDesc& scene, double radius_m) {
  SceneDesc ball = scene;
  ball.articulation = Articulation::kRigid;
  ball.device.holds = HeldPart::kTool;
  ball.friction = {};
  ball.friction.law = FrictionLaw::kNone;
  ball.pair.clear();
  ball.piece = {PieceDesc{}};
  ball.piece[0].radius_m = radius_m;
  ball.tip.radius_m = kAuto;
  for (PathPoint& point : ball.path.point) point.closing.clear();
  return ball;
}

class ModelChoice {
 public:
  ModelChoice(const SceneDesc& scene, const BakeRun& run) : scene_(scene), run_(run) { scene_.error_target.clear(); }

  CompileResult result(double target, bool only_elastic) {
    CompileResult elastic = compile_stated(scene_, run_, {});
    if (elastic.report.elastic.press.empty()) {
      say("error_target " + per_cent(target) +
          ": nothing was pressed (the warnings say why), so nothing is compared; elastic taken");
      return finished(std::move(elastic), nullptr);
    }
    const std::vector<CheckPress> presses = elastic.report.elastic.press;
    say("error_target " + per_cent(target) + " at " + std::to_string(presses.size()) + " places, balls of " +
        number_text(std::round(1e5 * presses[0].radius_m) / 100) + " mm");
    if (!only_elastic)
      for (const ModelCandidate& candidate : kCheaper)
        if (CompileResult cheap; tries(candidate, presses, target, cheap))
          return finished(std::move(cheap), &candidate);
    double worst = worst_of(elastic.report.elastic);
    if (worst > target && !is_auto(scene_.fem.edge_m)) {
      say(elastic_text(elastic.report) + ": above the target; elements of " +
          number_text(std::round(1e5 * kFiner * scene_.fem.edge_m) / 100) + " mm are tried");
      refine(elastic, worst);
    }
    say(elastic_text(elastic.report) + (worst <= target ? ": taken" : ": the best there is, above the target; taken"));
    if (worst > target)
      elastic.report.warnings.push_back(scene_.source.where("error_target") + ": " + per_cent(target) +
                                        " is not met by any model tried; the best errs by " + per_cent(worst) +
                                        ": try a smaller body.fem.edge_mm or contact.max_depth_mm, or accept it");
    return finished(std::move(elastic), nullptr);
  }

 private:
  void say(std::string line) { lines_.push_back(std::move(line)); }

  static double worst_of(const ElasticReport& report) {
    double worst = 0;
    for (const ElasticReport::Check& check : report.check) worst = std::max(worst, check.worst_error);
    return worst;
  }
  static std::string cost_text(const TickCost& cost) {
    return number_text(std::round(cost.instructions)) + " instructions at most";
  }
  static std::string elastic_text(const CompileReport& report) {
    return "elastic with " + std::to_string(report.elastic.soft) +
           " soft modes: " + per_cent(worst_of(report.elastic)) + " at worst, " + cost_text(report.cost);
  }
  double budget() const {
    return scene_.budget_instructions > 0 ? static_cast<double>(scene_.budget_instructions)
                                          : kBakeInstructionsPerSecond * scene_.device.period_s;
  }

  // Whether the candidate meets the target within the budget; says what became of it.
  bool tries(const ModelCandidate& candidate, const std::vector<CheckPress>& presses, double target,
             CompileResult& result) {
    const std::string name = candidate.name;
    SceneDesc scene = scene_;
    candidate.choose(scene);
    std::vector<CheckedPlace> places;
    try {
      const CompileResult ball = compile_stated(with_ball_alone(scene, presses[0].radius_m), run_, {});
      const OpenedImage image(ball.bytes);
      if (image.result().error != ImageError::kNone) throw ConfigError("its image does not open");
      for (const CheckPress& press : presses)
        if (!press.reference_N.empty()) places.push_back(checked_place(press, press_model(image.model(), press)));
      double worst = 0;
      for (const CheckedPlace& place : places) worst = std::max(worst, place.worst_error);
      if (!(worst <= target)) {
        say(name + ": " + per_cent(worst) + " at worst, above the target");
        return false;
      }
      result = compile_stated(scene, run_, places);
      const bool fits = result.report.cost.instructions <= budget();
      say(name + ": " + per_cent(worst) + " at worst, " + cost_text(result.report.cost) +
          (fits ? ": taken" : ", above the budget of " + number_text(budget())));
      return fits;
    } catch (const ConfigError& error) {
      say(name + ": is not for this scene (" + error.what() + ")");
      return false;
    }
  }

  void refine(CompileResult& elastic, double& worst) {
    SceneDesc finer = scene_;
    finer.fem.edge_m *= kFiner;
    CompileResult second = compile_stated(finer, run_, {});
    const double error = worst_of(second.report.elastic);
    if (second.report.elastic.press.empty() || !(error < worst) || second.report.cost.instructions > budget()) return;
    elastic = std::move(second);
    worst = error;
  }

  CompileResult finished(CompileResult result, const ModelCandidate* cheap) {
    say(std::string(cheap != nullptr ? cheap->what : "the elastic body (contact.backend = \"elastic\")") +
        "; leaves out: " + (cheap != nullptr ? cheap->leaves_out : kElasticLeavesOut));
    result.report.model = lines_;
    return result;
  }

  SceneDesc scene_;
  const BakeRun& run_;
  std::vector<std::string> lines_;
};

}  // namespace

std::span<const ModelCandidate> cheaper_models() { return kCheaper; }

CompileResult compile_stated(const SceneDesc& scene, const BakeRun& run, const std::vector<CheckedPlace>& checked) {
  CompileResult result = compile_image(scene, run);
  append_certificate(result.bytes, checked.empty() ? result.report.elastic.checked : checked, nullptr);
  result.report.image_bytes = result.bytes.size();
  return result;
}

CompileResult compile_scene(const SceneDesc& scene, const BakeRun& run) {
  return is_auto(error_target_share(scene)) ? compile_stated(scene, run, {}) : choose_model(scene, run);
}

CompileResult choose_model(const SceneDesc& scene, const BakeRun& run) {
  const bool only_elastic = scene.source.has("contact.backend");
  return ModelChoice(scene, run).result(error_target_share(scene), only_elastic);
}

}  // namespace palpate
