#include "sim_host/record/replay.h"

#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <string_view>

#include "rt_core/tick.h"
#include "sim_host/record/value_text.h"

namespace palpate {

namespace {

// Compares fields in the order they are presented and keeps the first that differs, bit for bit (NaN equals itself).
class FirstDifference {
 public:
  explicit FirstDifference(ReplayResult& result) : result_(&result) {}
  // `index`: of the region the field belongs to, or -1.
  template <typename T>
  void check(const char* stage, const char* field, const T& recorded, const T& replayed, std::int32_t index = -1) {
    static_assert(std::has_unique_object_representations_v<T> || sizeof(T) % sizeof(double) == 0);
    if (found_ || std::memcmp(&recorded, &replayed, sizeof(T)) == 0) return;
    found_ = true;
    result_->stage = stage;
    result_->field = index < 0 ? field : fmt::format("region[{}].{}", index, field);
    result_->recorded = text_of(recorded);
    result_->replayed = text_of(replayed);
  }
  bool found() const { return found_; }

 private:
  ReplayResult* result_;
  bool found_ = false;
};

// In this order, because a difference in an early stage explains those after it.
#define PALPATE_STAGE(name, function, shown, what) shown,
constexpr std::string_view kStageOrder[] = {PALPATE_STAGES(PALPATE_STAGE) "state"};
#undef PALPATE_STAGE

constexpr bool is_ordered(std::string_view stage) {
  for (const std::string_view known : kStageOrder)
    if (stage == known) return true;
  return false;
}
#define PALPATE_FIELD(type, name, stage, meaning) static_assert(is_ordered(stage), #name);
PALPATE_OUTPUT_FIELDS(PALPATE_FIELD)
PALPATE_REGION_RECORD_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD

// What one stage left in two records of one tick.
void check_stage(std::string_view stage, const TickRecord& a, const TickRecord& b, FirstDifference& difference) {
  if (stage == "sense") difference.check("sense", "tick", a.tick, b.tick);
  if (stage == "rows") difference.check("rows", "region_count", a.region_count, b.region_count);
#define PALPATE_FIELD(type, name, of, meaning) \
  if (stage == of) difference.check(of, "output." #name, a.output.name, b.output.name);
  PALPATE_OUTPUT_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
  for (std::int32_t i = 0; i < a.region_count && i < kMaxRegions; ++i) {
#define PALPATE_FIELD(type, name, of, meaning) \
  if (stage == of) difference.check(of, #name, a.region[i].name, b.region[i].name, i);
    PALPATE_REGION_RECORD_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
  }
}

void check_high_water(const HighWater& a, const HighWater& b, FirstDifference& difference) {
  static_assert(sizeof(HighWater) == 4 * sizeof(std::int32_t), "compare the new field here");
  difference.check("rows", "high_water.contacts", a.contacts, b.contacts);
  difference.check("rows", "high_water.regions", a.regions, b.regions);
  difference.check("rows", "high_water.traversal_stack", a.traversal_stack, b.traversal_stack);
  difference.check("rows", "high_water.gjk_support_calls", a.gjk_support_calls, b.gjk_support_calls);
}

}  // namespace

bool first_record_difference(const TickRecord& recorded, const TickRecord& replayed, ReplayResult& result) {
  FirstDifference difference(result);
  for (const std::string_view stage : kStageOrder) check_stage(stage, recorded, replayed, difference);
  check_high_water(recorded.high_water, replayed.high_water, difference);
  difference.check("state", "state_hash (no recorded output differs)", recorded.state_hash, replayed.state_hash);
  return difference.found();
}

namespace {

void check_scene(const RecordingHeader& header, const Model& model) {
  if (header.scene_hash == model.scene_hash) return;
  throw RecordingError(
      fmt::format("the recording was made with scene image {:016x} ('{}', {}), this image is {:016x} ('{}')",
                  header.scene_hash, header.scene_name, header.image_path, model.scene_hash, model.name));
}

}  // namespace

ReplayResult replay(RecordingReader& recording, const Model& model, const ReplayListener& listen) {
  check_scene(recording.header(), model);
  ReplayResult result;
  const ScratchPtr scratch = make_scratch(model);
  TickRecord recorded;
  if (!recording.state_known()) {
    throw RecordingError(
        "a slice of a longer run without the state before its first tick: it can be listed (--dump) but not replayed");
  }
  const StatePtr state = recording.initial_state(model);
  std::uint64_t expected = recording.first_sequence();
  while (recording.next(recorded)) {
    if (recorded.sequence != expected) {
      result.lost = recorded.sequence - expected;
      return result;
    }
    expected += 1;
    TickRecord replayed{};
    Output output;
    tick(model, *state, *scratch, recorded.input, output);
    fill_record(*state, recorded.input, output, replayed);
    if (listen) listen(recorded, replayed);
    if (first_record_difference(recorded, replayed, result)) {
      result.differs = true;
      result.tick = recorded.tick;
      return result;
    }
    result.ticks += 1;
  }
  result.lost = recording.lost();
  result.damage = recording.error();
  return result;
}

StatePtr for_each_state(RecordingReader& recording, const Model& model, const StateListener& listen) {
  check_scene(recording.header(), model);
  StatePtr state = recording.initial_state(model);
  const ScratchPtr scratch = make_scratch(model);
  TickRecord record;
  Output output;
  while (recording.next(record)) {
    if (record.tick != state->tick) {
      throw RecordingError(fmt::format("tick {} is missing in the recording: nothing after it is known", state->tick));
    }
    tick(model, *state, *scratch, record.input, output);
    if (!listen(record, *state)) return state;
  }
  return nullptr;
}

StatePtr state_after(RecordingReader& recording, const Model& model, std::uint64_t wanted) {
  StatePtr state =
      for_each_state(recording, model, [&](const TickRecord& record, const State&) { return record.tick != wanted; });
  if (!state) throw RecordingError(fmt::format("tick {} is not in the recording", wanted));
  return state;
}

}  // namespace palpate
