#include "sim_host/rings/telemetry_schema.h"

#include <algorithm>

namespace palpate {

namespace {

std::string quoted(std::string_view text) {
  std::string all = "\"";
  for (const char c : text) all += (c == '"' || c == '\\' ? std::string("\\") : std::string()) + c;
  return all + "\"";
}

std::string pair_of(std::string_view key, std::uint64_t value) { return quoted(key) + ": " + std::to_string(value); }

std::string field_text(const RecordField& field) {
  const bool text = field.type[0] == 'S';
  const std::string type = text ? "S" + std::to_string(field.count) : std::string("<") + field.type;
  const std::string shape = text || field.count == 1 ? "" : std::to_string(field.count);
  return "{\"name\": " + quoted(field.name) + ", \"type\": " + quoted(type) + ", \"shape\": [" + shape + "], " +
         pair_of("offset", field.offset) + ", \"unit\": " + quoted(field.unit) +
         ", \"meaning\": " + quoted(field.meaning) + "}";
}

std::string fields_text(const FieldTable& table) {
  std::string text;
  for (const RecordField& field : table)
    if (!field.is_reserved()) text += (text.empty() ? "\n  " : ",\n  ") + field_text(field);
  return "\"fields\": [" + text + "]";
}

// "name": {"1": "kInputHeld", ...}
struct BitName {
  const char* name;
  int bit;
};
constexpr BitName kStatusNames[] = {
#define PALPATE_BIT(name, bit, meaning, remedy) {#name, bit},
    PALPATE_STATUS_BITS(PALPATE_BIT)};
constexpr BitName kFaultNames[] = {PALPATE_FAULT_BITS(PALPATE_BIT)
#undef PALPATE_BIT
};
template <std::size_t N>
std::string bits_text(std::string_view key, const BitName (&table)[N]) {
  std::string text;
  for (const BitName& one : table)
    text += (text.empty() ? "" : ", ") + quoted(std::to_string(1ull << one.bit)) + ": " + quoted(one.name + 1);
  return quoted(key) + ": {" + text + "}";
}

}  // namespace

std::string telemetry_schema() {
  using Slot = TelemetryRegion::Slot;
  std::string text = "{\"format\": \"palpate-telemetry\", " + pair_of("version", kTelemetryVersion) +
                     ", \"byte_order\": \"little\",\n";
  text +=
      "\"header\": {" + pair_of("bytes", sizeof(TelemetryHeader)) + ", " + fields_text(kTelemetryHeaderFields) + "},\n";
  text += "\"ring\": {" + pair_of("newest", offsetof(TelemetryRegion, newest)) + ", " +
          pair_of("slots", offsetof(TelemetryRegion, slot)) + ", " + pair_of("slot_bytes", sizeof(Slot)) + ", " +
          pair_of("capacity", kTelemetryCapacity) + ", " + pair_of("sequence", offsetof(Slot, sequence)) + ", " +
          pair_of("record", offsetof(Slot, word)) + "},\n";
  text += "\"snapshot\": {" + pair_of("version", offsetof(TelemetryRegion, snapshot_version)) + ", " +
          pair_of("record", offsetof(TelemetryRegion, snapshot)) + "},\n";
  text += "\"record\": {" + pair_of("bytes", sizeof(TickRecord)) + ", " + fields_text(kTickFields) + "},\n";
  text += "\"regions\": {" + pair_of("offset", offsetof(TickRecord, region)) + ", " +
          pair_of("bytes", sizeof(RegionRecord)) + ", " + pair_of("capacity", kMaxRegions) +
          ", \"count\": \"region_count\", " + fields_text(kRegionFields) + "},\n";
  text += "\"later_scenes\": {" + pair_of("offset", offsetof(TelemetryRegion, later_scene)) + ", " +
          pair_of("bytes", sizeof(TelemetryScene)) + ", " + pair_of("capacity", kMostLaterScenes) + ", " +
          fields_text(kTelemetrySceneFields) + "},\n";
  text += "\"bits\": {" + bits_text("status", kStatusNames) + ",\n" + bits_text("fault", kFaultNames) + "},\n";
  text += "\"modes\": [\"idle\", \"force\", \"hold\", \"passive\", \"ramp\", \"fault\"]}\n";
  return text;
}

void describe_telemetry(TelemetryRegion& region) {
  const std::string text = telemetry_schema();
  if (text.size() >= kSchemaBytes) return;  // a test holds that it fits; a reader of this build needs none
  std::copy(text.begin(), text.end(), region.schema);
  region.header.schema_bytes = static_cast<std::uint32_t>(text.size());
}

}  // namespace palpate
