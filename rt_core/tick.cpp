#include "rt_core/tick.h"

#include "rt_core/tool/articulate.h"
#include "rt_core/tool/carrier.h"

namespace palpate {

namespace {

void publish(const State& state, const Scratch& scratch, Output& output) PALPATE_RT {
  output.contact_w = scratch.contact_wrench_w;
  output.palm_w = scratch.palm_w;
  output.tool_w = state.tool_w;
  output.energy_J = scratch.energy_J;
  output.residual_m = scratch.residual_m;
  output.strain = scratch.strain;
  output.status = scratch.status;
  output.contacts = scratch.contact_count;
  output.regions = 0;
  output.penetration_m = 0;
  for (const Region& region : state.region) {  // bound: kMaxRegions
    if (region.id == 0 || region.lost_ticks > 0) continue;
    output.regions += 1;
    output.penetration_m = max_of(output.penetration_m, region.depth_max_m);
  }
}

}  // namespace

void tick(const Model& model, State& state, Scratch& scratch, const Input& input, Output& output,
          const StageProbe& probe) PALPATE_RT {
  const auto mark = [&probe](Stage stage) PALPATE_RT {
    if (probe.mark != nullptr) probe.mark(probe.context, stage);
  };
  sense(model, state, scratch, input);
  if (is_articulated(model)) articulate(model, state, scratch, input);
  mark(Stage::kSense);
  collide(model, state, scratch);
  mark(Stage::kCollide);
  find_regions(model, state, scratch);
  mark(Stage::kRegions);
  compute_force(model, state, scratch);
  mark(Stage::kForce);
  make_safe(model, state, scratch, input, output);
  mark(Stage::kSafety);
  publish(state, scratch, output);
  state.tick += 1;
  mark(Stage::kPublish);
}

}  // namespace palpate
