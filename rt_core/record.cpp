#include "rt_core/record.h"

namespace palpate {

void fill_record(const State& state, const Input& input, const Output& output, TickRecord& record) PALPATE_RT {
  record.tick = state.tick - 1;
  record.state_hash = hash_state(state);
  record.input = input;
  record.output = output;
  record.high_water = state.high_water;
  record.region_count = 0;
  record.reserved = 0;
  for (const Region& region : state.region) {  // bound: kMaxRegions
    if (region.id == 0 || region.lost_ticks > 0) continue;
    record.region[record.region_count++] = {region.id,
                                            region.point_count,
                                            region.centre_w,
                                            state.live.stiffness * region.wrench_w.force_N,
                                            region.normal_w,
                                            region.depth_equivalent_m,
                                            static_cast<std::int32_t>(region.friction),
                                            0};
  }
  for (std::int32_t i = record.region_count; i < kMaxRegions; ++i) record.region[i] = {};
}

}  // namespace palpate
