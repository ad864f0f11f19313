#include "rt_core/stage_cost.h"

#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

// Prices are the dearest seen in callgrind over the shipped scenes (tests/bench, 2026-11-22) and up to twice that,
// because no scene meets every capacity at once. tests/bench/tick_instructions.sh compares them with every scene.
struct Sizes {
  double points, contacts, regions, joints, pieces, anchors, nodes;
};

Sizes sizes_of(const Model& model) noexcept {
  const ModelSizes& n = model.sizes;
  const bool nodal = method_of(model.params) == Method::kNodes;
  const auto rows = static_cast<double>(nodal ? n.n_nodal : n.n_tool_point);
  const double contacts = min_of(rows, static_cast<double>(kMaxContacts));
  return {static_cast<double>(n.n_tool_point),
          contacts,
          min_of(contacts, static_cast<double>(kMaxRegions)),
          static_cast<double>(n.n_joint),
          static_cast<double>(n.n_piece),
          static_cast<double>(n.n_anchor),
          static_cast<double>(n.n_nodal)};
}

// Points and tips: the share of surface work and the query that ends it; what is skipped; clusters of all pairs; and a
// cross-check of every region that was lost at once.
double find_points(const Model& model, const Sizes& n) noexcept {
  const double looks = surface_work_share(model.params) + kMaxQueryWork;
  const double overlap = n.regions * kGjkSupportBudget * 100;
  return 2000 + kSurfaceLookInstructions * looks + 200 * n.points + 30 * n.contacts * n.contacts + overlap;
}

// Nodes: four at a time against every piece, carried by every region.
double find_nodes(const Sizes& n) noexcept {
  return 50000 + n.pieces * (n.nodes / 4 + 1) * (250 + 60 * n.regions) + 2500 * n.contacts;
}

}  // namespace

double least_stage_cost(const Model& model, Stage stage) noexcept {
  const Sizes n = sizes_of(model);
  const Method method = method_of(model.params);
  switch (stage) {
    case Stage::kSense:
      return 5000;
    case Stage::kArticulate:
      return 500 + 1000 * n.joints;
    case Stage::kFindRows:
      return method == Method::kNodes ? find_nodes(n) : find_points(model, n);
    case Stage::kSolve:
      if (method == Method::kNodes) return 50000 + 12000 * n.contacts;  // 64 at once: 424,000 (2026-11-22)
      if (method == Method::kTips) return 5000 + 10000 * n.regions + 600 * n.regions * n.regions;
      return 3000 + 600 * n.contacts + 1500 * n.regions + 20 * n.regions * n.regions * n.regions;
    case Stage::kAccount:
      if (method == Method::kNodes) return 10000 + 1500 * n.contacts;
      return 5000 + 500 * n.contacts + n.regions * (2000 + 500 * n.anchors);
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
