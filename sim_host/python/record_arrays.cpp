#include "sim_host/python/record_arrays.h"

#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>

namespace palpate {

namespace py = pybind11;

namespace {

struct RegionRow {
  std::uint64_t sequence, tick;
  RegionRecord region;
};
constexpr std::size_t kTickBytes = offsetof(TickRecord, region);

struct Field {
  std::string name;
  const char* format;  // NumPy's
  std::size_t offset;
  std::string meaning;
};

template <class T>
constexpr const char* format_of() {
  if constexpr (std::is_same_v<T, double>) return "<f8";
  if constexpr (std::is_same_v<T, float>) return "<f4";
  if constexpr (std::is_same_v<T, std::uint64_t>) return "<u8";
  if constexpr (std::is_same_v<T, std::int64_t>) return "<i8";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "<u4";
  if constexpr (std::is_same_v<T, std::int32_t> || std::is_enum_v<T>) return "<i4";
  if constexpr (std::is_same_v<T, Vec3>) return "(3,)<f8";
  if constexpr (std::is_same_v<T, Quat>) return "(4,)<f8";
}

// Wrenches and poses become two fields each: `device_w` is `device_force_N` and `device_torque_Nm`.
template <class T>
void add_field(std::vector<Field>& fields, const std::string& name, std::size_t offset, const char* meaning) {
  const std::string stem = name.ends_with("_w") ? name.substr(0, name.size() - 2) : name;
  if constexpr (std::is_same_v<T, Wrench>) {
    fields.push_back({stem + "_force_N", format_of<Vec3>(), offset + offsetof(Wrench, force_N), meaning});
    fields.push_back({stem + "_torque_Nm", format_of<Vec3>(), offset + offsetof(Wrench, torque_Nm), meaning});
  } else if constexpr (std::is_same_v<T, Pose>) {
    fields.push_back({stem + "_position_m", format_of<Vec3>(), offset + offsetof(Pose, position_m), meaning});
    fields.push_back({stem + "_orientation", format_of<Quat>(), offset + offsetof(Pose, orientation),
                      std::string(meaning) + ": unit quaternion w, x, y, z"});
  } else {
    fields.push_back({name, format_of<T>(), offset, meaning});
  }
}

void add_input(std::vector<Field>& fields) {
  const auto add = [&]<class T>(const char* name, std::size_t offset, const char* meaning, T Input::*) {
    add_field<T>(fields, name, offsetof(TickRecord, input) + offset, meaning);
  };
  add("input_w", offsetof(Input, pose_w), "pose that came in: of the handle, or of the tool in a press",
      &Input::pose_w);
  add("stale_ticks", offsetof(Input, stale_ticks), "ticks without a fresh sample, 0: fresh", &Input::stale_ticks);
  add("commands", offsetof(Input, commands), "bits: 1 arm, 2 stop, 4 reset, 8 stall, 16 unheard", &Input::commands);
  add("device_fault", offsetof(Input, device_fault), "fault bits found by the loop", &Input::device_fault);
  add("overrun_ticks", offsetof(Input, overrun_ticks), "deadlines missed just before", &Input::overrun_ticks);
  add("buttons", offsetof(Input, buttons), "of the device", &Input::buttons);
  add("drive", offsetof(Input, drive), "who moves the tool: 0 device, 1 the pose is the tool's, 2 held", &Input::drive);
  const std::size_t joints = offsetof(TickRecord, input) + offsetof(Input, joints);
  fields.push_back(
      {"closing", "(5,)<f4", joints + offsetof(JointCommand, closing), "commanded closing of each finger"});
  fields.push_back(
      {"joint_target", "(21,)<f4", joints + offsetof(JointCommand, target), "commanded positions, rad or m"});
  fields.push_back({"joint_direct", "<u4", joints + offsetof(JointCommand, direct), "bit i: joint i has a position"});
#define PALPATE_FIELD(name, lowest, highest, key, meaning)                                              \
  fields.push_back({"live_" #name, format_of<float>(),                                                  \
                    offsetof(TickRecord, input) + offsetof(Input, live) + offsetof(LiveSettings, name), \
                    std::string("wanted factor: ") + meaning});
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  static_assert(kMaxFingers == 5 && kMaxJoints == 21, "the formats above");
}

void add_timing(std::vector<Field>& fields) {
  const auto add = [&]<class T>(const char* name, std::size_t offset, const char* meaning, T TickTiming::*) {
    add_field<T>(fields, name, offsetof(TickRecord, timing) + offset, meaning);
  };
  add("deadline_ns", offsetof(TickTiming, deadline_ns), "planned wake-up, CLOCK_MONOTONIC or virtual time",
      &TickTiming::deadline_ns);
  add("wake_latency_ns", offsetof(TickTiming, wake_latency_ns), "wake-up minus deadline", &TickTiming::wake_latency_ns);
  add("receive_ns", offsetof(TickTiming, receive_ns), "time to take the sample", &TickTiming::receive_ns);
  add("compute_ns", offsetof(TickTiming, compute_ns), "time of the tick", &TickTiming::compute_ns);
  add("transmit_ns", offsetof(TickTiming, transmit_ns), "time to send", &TickTiming::transmit_ns);
  add("publish_ns", offsetof(TickTiming, publish_ns), "time to publish the record before", &TickTiming::publish_ns);
  fields.push_back({"stage_ns", "(7,)<i4", offsetof(TickRecord, timing) + offsetof(TickTiming, stage_ns),
                    "time of each stage: sense, articulate, rows, solve, account, safety, publish"});
  static_assert(kStageCount == 7, "the format above");
}

std::vector<Field> fields_of_tick() {
  std::vector<Field> fields;
  add_field<std::uint64_t>(fields, "sequence", offsetof(TickRecord, sequence), "1, 2, 3...; a gap is a lost record");
  add_field<std::uint64_t>(fields, "tick", offsetof(TickRecord, tick), "number of the tick since the reset");
  add_field<std::uint64_t>(fields, "state_hash", offsetof(TickRecord, state_hash), "of the whole state after the tick");
  add_timing(fields);
  add_input(fields);
#define PALPATE_FIELD(type, name, stage, meaning) \
  add_field<type>(fields, #name, offsetof(TickRecord, output) + offsetof(Output, name), meaning);
  PALPATE_OUTPUT_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
  add_field<std::int32_t>(fields, "region_count", offsetof(TickRecord, region_count), "rows of this tick in `regions`");
  std::erase_if(fields, [](const Field& field) { return field.name == "reserved"; });
  return fields;
}

std::vector<Field> fields_of_region() {
  std::vector<Field> fields;
  add_field<std::uint64_t>(fields, "sequence", offsetof(RegionRow, sequence), "of the tick");
  add_field<std::uint64_t>(fields, "tick", offsetof(RegionRow, tick), "number of the tick since the reset");
#define PALPATE_FIELD(type, name, stage, meaning) \
  add_field<type>(fields, #name, offsetof(RegionRow, region) + offsetof(RegionRecord, name), meaning);
  PALPATE_REGION_RECORD_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
  std::erase_if(fields, [](const Field& field) { return field.name == "reserved"; });
  return fields;
}

py::dtype dtype_of(const std::vector<Field>& fields, std::size_t bytes) {
  py::list names, formats, offsets;
  for (const Field& field : fields) {
    names.append(field.name);
    formats.append(field.format);
    offsets.append(field.offset);
  }
  return py::dtype(names, formats, offsets, static_cast<py::ssize_t>(bytes));
}

py::list names_and_meanings(const std::vector<Field>& fields) {
  py::list list;
  for (const Field& field : fields) list.append(py::make_tuple(field.name, field.meaning));
  return list;
}

void append(std::vector<std::byte>& bytes, const void* data, std::size_t size) {
  const auto* from = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), from, from + size);
}

// An array that owns `bytes`.
py::array array_of(const py::dtype& type, std::vector<std::byte>&& bytes) {
  auto* kept = new std::vector<std::byte>(std::move(bytes));
  const py::capsule owner(kept, [](void* memory) { delete static_cast<std::vector<std::byte>*>(memory); });
  return {type, {kept->size() / static_cast<std::size_t>(type.itemsize())}, {}, kept->data(), owner};
}

}  // namespace

py::dtype tick_dtype() { return dtype_of(fields_of_tick(), kTickBytes); }
py::dtype region_dtype() { return dtype_of(fields_of_region(), sizeof(RegionRow)); }
py::list tick_fields() { return names_and_meanings(fields_of_tick()); }
py::list region_fields() { return names_and_meanings(fields_of_region()); }

void RecordArrays::reserve(std::size_t ticks) { ticks_.reserve(ticks * kTickBytes); }

void RecordArrays::add(const TickRecord& record) {
  append(ticks_, &record, kTickBytes);
  for (std::int32_t i = 0; i < record.region_count && i < kMaxRegions; ++i) {
    const RegionRow row{record.sequence, record.tick, record.region[i]};
    append(regions_, &row, sizeof row);
  }
  count_ += 1;
}

py::tuple RecordArrays::take() {
  count_ = 0;
  return py::make_tuple(array_of(tick_dtype(), std::move(ticks_)), array_of(region_dtype(), std::move(regions_)));
}

}  // namespace palpate
