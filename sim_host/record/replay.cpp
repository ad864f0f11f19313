#include "sim_host/record/replay.h"

#include <fmt/format.h>

#include <cstring>
#include <memory>

#include "rt_core/tick.h"

namespace palpate {

namespace {

std::string text_of(double value) { return fmt::format("{:.17g}", value); }
std::string text_of(std::int32_t value) { return fmt::format("{}", value); }
std::string text_of(std::uint32_t value) { return fmt::format("{:#x}", value); }
std::string text_of(std::uint64_t value) { return fmt::format("{:016x}", value); }
std::string text_of(Mode value) { return fmt::format("{}", static_cast<std::int32_t>(value)); }
std::string text_of(Vec3 v) { return fmt::format("({:.17g}, {:.17g}, {:.17g})", v.x, v.y, v.z); }
std::string text_of(const Wrench& w) { return text_of(w.force_N) + " " + text_of(w.torque_Nm); }
std::string text_of(const Pose& p) {
  const Quat& q = p.orientation;
  return fmt::format("{} ({:.17g}, {:.17g}, {:.17g}, {:.17g})", text_of(p.position_m), q.w, q.x, q.y, q.z);
}

// Compares fields in the order they are presented and keeps the first that differs, bit for bit (NaN equals itself).
class FirstDifference {
 public:
  explicit FirstDifference(ReplayResult& result) : result_(&result) {}
  template <typename T>
  void check(const char* stage, const std::string& field, const T& recorded, const T& replayed) {
    static_assert(std::has_unique_object_representations_v<T> || sizeof(T) % sizeof(double) == 0);
    if (found_ || std::memcmp(&recorded, &replayed, sizeof(T)) == 0) return;
    found_ = true;
    result_->stage = stage;
    result_->field = field;
    result_->recorded = text_of(recorded);
    result_->replayed = text_of(replayed);
  }
  bool found() const { return found_; }

 private:
  ReplayResult* result_;
  bool found_ = false;
};

void check_regions(const TickRecord& a, const TickRecord& b, FirstDifference& difference) {
  difference.check("regions", "region_count", a.region_count, b.region_count);
  for (std::int32_t i = 0; i < a.region_count && i < kMaxRegions; ++i) {
    const RegionRecord &x = a.region[i], &y = b.region[i];
    const auto name = [&](const char* field) { return fmt::format("region[{}].{}", i, field); };
    difference.check("regions", name("id"), x.id, y.id);
    difference.check("regions", name("point_count"), x.point_count, y.point_count);
  }
  for (std::int32_t i = 0; i < a.region_count && i < kMaxRegions; ++i) {
    const RegionRecord &x = a.region[i], &y = b.region[i];
    const auto name = [&](const char* field) { return fmt::format("region[{}].{}", i, field); };
    difference.check("force", name("centre_w"), x.centre_w, y.centre_w);
    difference.check("force", name("force_w"), x.force_w, y.force_w);
    difference.check("force", name("depth_equivalent_m"), x.depth_equivalent_m, y.depth_equivalent_m);
    difference.check("force", name("friction"), x.friction, y.friction);
  }
}

}  // namespace

bool first_record_difference(const TickRecord& recorded, const TickRecord& replayed, ReplayResult& result) {
  FirstDifference difference(result);
  const Output &a = recorded.output, &b = replayed.output;
  difference.check("sense", "tick", recorded.tick, replayed.tick);
  difference.check("collide", "output.contacts", a.contacts, b.contacts);
  difference.check("collide", "high_water.traversal_stack", recorded.high_water.traversal_stack,
                   replayed.high_water.traversal_stack);
  difference.check("collide", "high_water.gjk_support_calls", recorded.high_water.gjk_support_calls,
                   replayed.high_water.gjk_support_calls);
  difference.check("regions", "output.regions", a.regions, b.regions);
  difference.check("regions", "output.penetration_m", a.penetration_m, b.penetration_m);
  check_regions(recorded, replayed, difference);
  difference.check("force", "output.contact_w", a.contact_w, b.contact_w);
  difference.check("force", "output.energy_J", a.energy_J, b.energy_J);
  difference.check("force", "output.residual_m", a.residual_m, b.residual_m);
  difference.check("safety", "output.tool_w", a.tool_w, b.tool_w);
  difference.check("safety", "output.device_w", a.device_w, b.device_w);
  difference.check("safety", "output.ramp", a.ramp, b.ramp);
  difference.check("safety", "output.mode", a.mode, b.mode);
  difference.check("safety", "output.fault", a.fault, b.fault);
  difference.check("safety", "output.status", a.status, b.status);
  difference.check("state", "state_hash (no recorded output differs)", recorded.state_hash, replayed.state_hash);
  return difference.found();
}

ReplayResult replay(RecordingReader& recording, const Model& model, const ReplayListener& listen) {
  const RecordingHeader& header = recording.header();
  if (header.scene_hash != model.scene_hash) {
    throw RecordingError(
        fmt::format("the recording was made with scene image {:016x} ('{}', {}), this image is {:016x} ('{}')",
                    header.scene_hash, header.scene_name, header.image_path, model.scene_hash, model.name));
  }
  ReplayResult result;
  State state = recording.initial_state();
  const auto scratch = std::make_unique<Scratch>();
  TickRecord recorded;
  if (!recording.state_known()) {
    throw RecordingError(
        "a slice of a longer run without the state before its first tick: it can be listed (--dump) but not replayed");
  }
  std::uint64_t expected = recording.first_sequence();
  while (recording.next(recorded)) {
    if (recorded.sequence != expected) {
      result.lost = recorded.sequence - expected;
      return result;
    }
    expected += 1;
    TickRecord replayed{};
    Output output;
    tick(model, state, *scratch, recorded.input, output);
    fill_record(model, state, recorded.input, output, replayed);
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

}  // namespace palpate
