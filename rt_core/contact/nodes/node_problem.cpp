#include "rt_core/contact/nodes/node_problem.h"

namespace palpate {

void place_problem(const Model& model, NodalScratch& memory, Arena& arena) noexcept {
  if (model.sizes.n_nodal == 0) return;
  const std::int64_t fours = whole_lanes(static_cast<std::int32_t>(model.sizes.n_vertex), 4) / 4;
  arena.place(memory.problem, 1);
  arena.place(memory.near, fours + 1);
  arena.place(memory.memory_of, 4 * fours);
  arena.place(memory.near_of, fours);
}

ContactProblem* create_problem(NodalScratch& memory) noexcept {
  if (memory.problem.size() == 0) return nullptr;
  ContactProblem* problem = memory.problem.data();
  problem->near = memory.near.data();
  problem->memory_of = memory.memory_of.data();
  problem->near_of = memory.near_of.data();
  return problem;
}

}  // namespace palpate
