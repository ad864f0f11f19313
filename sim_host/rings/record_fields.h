// Every field of what telemetry and recordings keep of a tick, under flat names: type, place, shape, unit, meaning.
// One table, from which come the schema text in the shared segment (telemetry_schema.h), NumPy's types, the table of
// `palpate replay --dump` and docs/record_format.md. It cannot fall behind the structs: fields must cover every byte of
// them, one after the other, and every floating-point field must have a unit, or this does not compile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "rt_core/record.h"

namespace palpate {

struct RecordField {
  static constexpr std::size_t kNameBytes = 40;
  char name[kNameBytes] = {};  // zero-terminated
  char type[3] = {};         // as NumPy says it, little-endian: f8, f4, u8, i8, u4, i4; S: bytes of a text, zero-padded
  std::uint32_t count = 1;   // values, one after the other
  std::uint32_t offset = 0;  // bytes from the record's beginning
  std::string_view unit;     // "": a count, a number of something, bits
  const char* meaning = "";

  constexpr std::uint32_t value_bytes() const { return type[0] == 'S' ? 1 : static_cast<std::uint32_t>(type[1] - '0'); }
  constexpr std::uint32_t end() const { return offset + count * value_bytes(); }
  constexpr bool is_reserved() const { return std::string_view(name) == "reserved"; }
};

// The name's own suffix, or what names without one are in.
constexpr std::string_view unit_of(std::string_view name) {
  constexpr std::string_view kSuffix[][2] = {{"_N_per_m", "N/m"}, {"_Nm", "N m"}, {"_N", "N"},
                                             {"_m", "m"},         {"_J", "J"},    {"_ns", "ns"}};
  constexpr std::string_view kName[][2] = {
      {"centre_w", "m"}, {"force_w", "N"}, {"normal_w", "1"},           {"strain", "1"},
      {"ramp", "1"},     {"closing", "1"}, {"joint_target", "rad or m"}};
  for (const auto& [of, unit] : kName)
    if (name == of) return unit;
  for (const auto& [suffix, unit] : kSuffix)
    if (name.ends_with(suffix)) return unit;
  return name.ends_with("_orientation") || name.starts_with("live_") ? "1" : "";
}

class FieldTable {
 public:
  constexpr const RecordField* begin() const { return field_; }
  constexpr const RecordField* end() const { return field_ + size_; }
  constexpr std::size_t size() const { return size_; }

  // A member of type T. Wrenches and poses become two fields each: `device_w` is device_force_N and device_torque_Nm.
  template <class T>
  constexpr void add(std::string_view name, std::size_t offset, const char* meaning) {
    const std::string_view stem = name.ends_with("_w") ? name.substr(0, name.size() - 2) : name;
    if constexpr (std::is_same_v<T, Wrench>) {
      put<Vec3>(stem, "_force_N", offset + offsetof(Wrench, force_N), meaning);
      put<Vec3>(stem, "_torque_Nm", offset + offsetof(Wrench, torque_Nm), meaning);
    } else if constexpr (std::is_same_v<T, Pose>) {
      put<Vec3>(stem, "_position_m", offset + offsetof(Pose, position_m), meaning);
      put<Quat>(stem, "_orientation", offset + offsetof(Pose, orientation), meaning);
    } else {
      put<T>(name, "", offset, meaning);
    }
  }

  // Whether the fields lie one after the other from 0 to `bytes`.
  constexpr bool covers(std::size_t bytes) const {
    std::size_t at = 0;
    for (const RecordField& field : *this) {
      if (field.offset != at) return false;
      at = field.end();
    }
    return at == bytes;
  }
  constexpr bool has_units() const {
    for (const RecordField& field : *this)
      if (field.type[0] == 'f' && field.unit.empty()) return false;
    return true;
  }

 private:
  static constexpr std::size_t kMost = 80;

  template <class T>
  constexpr void put(std::string_view stem, std::string_view suffix, std::size_t offset, const char* meaning) {
    RecordField& field = field_[size_++];
    std::size_t at = 0;
    for (const char c : stem) field.name[at++] = c;
    for (const char c : suffix) field.name[at++] = c;
    field.name[at] = '\0';
    field.offset = static_cast<std::uint32_t>(offset);
    field.unit = unit_of({field.name, at});
    field.meaning = meaning;
    using Value = std::remove_all_extents_t<T>;
    field.count = sizeof(T) / sizeof(Value);
    if constexpr (std::is_same_v<Value, Vec3> || std::is_same_v<Value, Quat>) {
      static_assert(sizeof(Vec3) == 24 && sizeof(Quat) == 32);
      field.count *= sizeof(Value) / sizeof(double);
      set_type<double>(field);
    } else {
      set_type<Value>(field);
    }
  }
  template <class T>
  static constexpr void set_type(RecordField& field) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    if constexpr (std::is_same_v<T, char>) {
      field.type[0] = 'S';
    } else {
      field.type[0] = std::is_floating_point_v<T> ? 'f' : std::is_unsigned_v<T> ? 'u' : 'i';
      field.type[1] = static_cast<char>('0' + sizeof(T));
    }
  }

  RecordField field_[kMost] = {};
  std::size_t size_ = 0;
};

// A struct's member as a field, under its own name or another.
#define PALPATE_NAMED(Struct, member, name, meaning) \
  table.add<decltype(Struct::member)>(name, base + offsetof(Struct, member), meaning)
#define PALPATE_MEMBER(Struct, member, meaning) PALPATE_NAMED(Struct, member, #member, meaning)

constexpr void add_timing_fields(FieldTable& table, std::size_t base) {
  PALPATE_MEMBER(TickTiming, deadline_ns, "planned wake-up, CLOCK_MONOTONIC or virtual time");
  PALPATE_MEMBER(TickTiming, wake_latency_ns, "wake-up minus deadline");
  PALPATE_MEMBER(TickTiming, receive_ns, "time to take the sample");
  PALPATE_MEMBER(TickTiming, compute_ns, "time of the tick");
  PALPATE_MEMBER(TickTiming, transmit_ns, "time to send");
  PALPATE_MEMBER(TickTiming, publish_ns, "time to publish the record before");
  PALPATE_MEMBER(TickTiming, stage_ns,
                 "time of each stage: sense, articulate, rows, solve, account, safety, publish; 0 in virtual time");
}

constexpr void add_joint_fields(FieldTable& table, std::size_t base) {
  PALPATE_MEMBER(JointCommand, closing, "commanded closing of each finger, 0 open, 1 closed");
  PALPATE_NAMED(JointCommand, target, "joint_target", "commanded positions of joints");
  PALPATE_NAMED(JointCommand, direct, "joint_direct",
                "bit i: joint i goes to its target whatever its finger's closing");
  PALPATE_MEMBER(JointCommand, reserved, "0");
}

constexpr void add_input_fields(FieldTable& table, std::size_t base) {
  PALPATE_NAMED(Input, pose_w, "input_w", "what came in: of the handle, or of the tool in a press");
  PALPATE_MEMBER(Input, stale_ticks, "ticks without a fresh sample, 0: fresh");
  PALPATE_MEMBER(Input, commands, "bits: 1 arm, 2 stop, 4 reset, 8 stall, 16 unheard");
  PALPATE_MEMBER(Input, device_fault, "fault bits found by the loop");
  PALPATE_MEMBER(Input, overrun_ticks, "deadlines missed just before");
  PALPATE_MEMBER(Input, buttons, "of the device");
  PALPATE_MEMBER(Input, drive, "who moves the tool: 0 device, 1 the pose is the tool's, 2 held");
  add_joint_fields(table, base + offsetof(Input, joints));
#define PALPATE_FIELD(name, lowest, highest, key, meaning)                                     \
  table.add<float>("live_" #name, base + offsetof(Input, live) + offsetof(LiveSettings, name), \
                   "wanted factor: " meaning);
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  PALPATE_NAMED(Input, second_w, "input_second_w", "of the second device's handle");
  PALPATE_MEMBER(Input, command_lag, "commands sent since the newest one that the device says it obeys");
  PALPATE_MEMBER(Input, reserved, "0");
}

constexpr void add_output_fields(FieldTable& table, std::size_t base) {
#define PALPATE_FIELD(type, name, stage, meaning) PALPATE_MEMBER(Output, name, meaning);
  PALPATE_OUTPUT_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
}

constexpr void add_high_water_fields(FieldTable& table, std::size_t base) {
  PALPATE_NAMED(HighWater, contacts, "most_contacts", "since the reset");
  PALPATE_NAMED(HighWater, regions, "most_regions", "since the reset");
  PALPATE_NAMED(HighWater, traversal_stack, "most_traversal_stack", "entries since the reset");
  PALPATE_NAMED(HighWater, gjk_support_calls, "most_gjk_support_calls", "of one query since the reset");
}

// Of a TickRecord up to its regions.
constexpr FieldTable fields_of_tick() {
  FieldTable table;
  constexpr std::size_t base = 0;
  PALPATE_MEMBER(TickRecord, sequence, "1, 2, 3... as written; a gap is a lost record");
  PALPATE_MEMBER(TickRecord, tick, "number of the tick since the reset");
  PALPATE_MEMBER(TickRecord, state_hash, "of the whole state after the tick");
  add_timing_fields(table, offsetof(TickRecord, timing));
  add_input_fields(table, offsetof(TickRecord, input));
  add_output_fields(table, offsetof(TickRecord, output));
  add_high_water_fields(table, offsetof(TickRecord, high_water));
  PALPATE_MEMBER(TickRecord, region_count, "regions that follow");
  PALPATE_MEMBER(TickRecord, reserved, "0");
  return table;
}

constexpr FieldTable fields_of_region() {
  FieldTable table;
  constexpr std::size_t base = 0;
#define PALPATE_FIELD(type, name, stage, meaning) PALPATE_MEMBER(RegionRecord, name, meaning);
  PALPATE_REGION_RECORD_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return table;
}

inline constexpr FieldTable kTickFields = fields_of_tick();
inline constexpr FieldTable kRegionFields = fields_of_region();
static_assert(kTickFields.covers(offsetof(TickRecord, region)) && kRegionFields.covers(sizeof(RegionRecord)),
              "a member of TickRecord, TickTiming, Input, Output, HighWater or RegionRecord lacks its line here");
static_assert(kTickFields.has_units() && kRegionFields.has_units(), "a field without a unit: see unit_of()");

}  // namespace palpate
