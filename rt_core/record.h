// One tick as telemetry and recordings keep it: inputs, outputs, timing and the hash that replay verifies.
#pragma once

#include <cstdint>
#include <type_traits>

#include "rt_core/io.h"
#include "rt_core/limits.h"
#include "rt_core/state.h"

namespace palpate {

// X(type, name, stage, meaning). Compared by replay, as PALPATE_OUTPUT_FIELDS is.
#define PALPATE_REGION_RECORD_FIELDS(X)                                               \
  X(std::uint32_t, id, "rows", "unique since reset")                                  \
  X(std::int32_t, point_count, "rows", "tool points or nodes in contact")             \
  X(Vec3, centre_w, "account", "equivalent contact point on the rest surface")        \
  X(Vec3, force_w, "account", "on the tool, friction included")                       \
  X(Vec3, normal_w, "rows", "unit, of its normal force on the tool")                  \
  X(double, depth_equivalent_m, "account", "depth at which the law gives this force") \
  X(std::int32_t, friction, "account", "FrictionMode")                                \
  X(std::int32_t, reserved, "account", "0")

struct RegionRecord {
#define PALPATE_FIELD(type, name, stage, meaning) type name;
  PALPATE_REGION_RECORD_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
};

// Where the time of one period went, in ns. Taken by the HAL loop, never inside rt_core.
struct TickTiming {
  std::int64_t deadline_ns;                                      // planned wake-up, CLOCK_MONOTONIC (or virtual time)
  std::int32_t wake_latency_ns;                                  // actual wake-up minus deadline
  std::int32_t receive_ns, compute_ns, transmit_ns, publish_ns;  // publish: of the previous tick
  std::int32_t stage_ns[kStageCount];
};

struct TickRecord {
  std::uint64_t sequence;    // 1, 2, 3... as written; a gap in a recording is a lost record
  std::uint64_t tick;        // State::tick before the tick
  std::uint64_t state_hash;  // hash_state after the tick
  TickTiming timing;
  Input input;
  Output output;
  HighWater high_water;
  std::int32_t region_count;
  std::int32_t reserved;
  RegionRecord region[kMaxRegions];
};

static_assert(std::is_trivially_copyable_v<TickRecord>);
static_assert(sizeof(TickRecord) % 8 == 0, "rings move records as 64-bit words");

// Fills tick, hash, output and regions of a record after tick(); timing and sequence stay the caller's.
void fill_record(const State& state, const Input& input, const Output& output, TickRecord& record) PALPATE_RT;

}  // namespace palpate
