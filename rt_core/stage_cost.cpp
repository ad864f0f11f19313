#include "rt_core/stage_cost.h"

#include "rt_core/contact/contact.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

SceneSizes scene_sizes(const Model& model) noexcept {
  const ModelSizes& n = model.sizes;
  const auto rows = static_cast<double>(n.n_nodal > 0 ? n.n_nodal : n.n_tool_point);
  const double contacts = min_of(rows, static_cast<double>(kMaxContacts));
  return {static_cast<double>(n.n_tool_point),
          contacts,
          min_of(contacts, static_cast<double>(kMaxRegions)),
          static_cast<double>(n.n_joint),
          static_cast<double>(n.n_piece),
          static_cast<double>(n.n_anchor),
          static_cast<double>(n.n_nodal)};
}

double surface_search_cost(const Model& model) noexcept {
  return kSurfaceLookInstructions * (surface_work_share(model.params) + kMaxQueryWork);
}

double find_points_cost(const Model& model, const SceneSizes& n) noexcept {
  const double overlap = n.regions * kGjkSupportBudget * 100;
  return 2000 + surface_search_cost(model) + 200 * n.points + 30 * n.contacts * n.contacts + overlap;
}

double rub_regions_cost(const SceneSizes& n) noexcept {
  return 5000 + 500 * n.contacts + n.regions * (2000 + 500 * n.anchors);
}

double least_stage_cost(const Model& model, Stage stage) noexcept {
  switch (stage) {
    case Stage::kSense:
      return 5000;
    case Stage::kArticulate:
      return 500 + 1000 * scene_sizes(model).joints;
    case Stage::kFindRows:
    case Stage::kSolve:
    case Stage::kAccount:
      return contact_method(method_of(model)).least_cost(model, scene_sizes(model), stage);
    case Stage::kSafety:
      return 2000;
    case Stage::kPublish:
      return 1000;
  }
  return 0;
}

double worst_tick_instructions(const Model& model) noexcept {
  double sum = 0;
  for (const StageCost& stage : model.stage_cost) sum += stage.instructions;
  return sum;
}

}  // namespace palpate
