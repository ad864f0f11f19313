// What lies where in the telemetry region, as JSON text inside it: whoever maps the region needs no header of ours.
// Made from record_fields.h. docs/record_format.md shows how to read it, docs/examples/watch.py does.
#pragma once

#include <string>

#include "sim_host/rings/record_fields.h"
#include "sim_host/rings/telemetry.h"

namespace palpate {

constexpr FieldTable fields_of_telemetry_header() {
  FieldTable table;
  constexpr std::size_t base = 0;
  PALPATE_MEMBER(TelemetryHeader, magic, "LPTELT01");
  PALPATE_MEMBER(TelemetryHeader, version, "of this layout");
  PALPATE_MEMBER(TelemetryHeader, schema_bytes, "length of this text");
  PALPATE_MEMBER(TelemetryHeader, schema_offset, "where it begins");
  PALPATE_MEMBER(TelemetryHeader, record_words, "64-bit words of a record");
  PALPATE_MEMBER(TelemetryHeader, layout_hash, "of the record's and the state's layout: equal in builds that fit");
  PALPATE_MEMBER(TelemetryHeader, total_bytes, "of the region");
  PALPATE_MEMBER(TelemetryHeader, capacity, "slots of the ring");
  PALPATE_MEMBER(TelemetryHeader, scene_hash, "checksum of the image that is rendered");
  PALPATE_MEMBER(TelemetryHeader, period_ns, "of the loop");
  PALPATE_MEMBER(TelemetryHeader, scene_name, "of the scene");
  PALPATE_MEMBER(TelemetryHeader, build_id, "version, compiler and flags of the controller");
  PALPATE_MEMBER(TelemetryHeader, image_path, "of the image");
  return table;
}
inline constexpr FieldTable kTelemetryHeaderFields = fields_of_telemetry_header();
static_assert(kTelemetryHeaderFields.covers(sizeof(TelemetryHeader)),
              "a member of TelemetryHeader lacks its line here");
static_assert(offsetof(TelemetryHeader, version) == 8 && offsetof(TelemetryHeader, schema_bytes) == 12 &&
                  offsetof(TelemetryHeader, schema_offset) == 16,
              "these places are promised for every version");

constexpr FieldTable fields_of_telemetry_scene() {
  FieldTable table;
  constexpr std::size_t base = 0;
  table.add<std::uint64_t>("first_sequence", offsetof(TelemetryScene, first_sequence),
                           "of its first record; 0: not yet");
  PALPATE_MEMBER(TelemetryScene, scene_hash, "checksum of its image");
  PALPATE_MEMBER(TelemetryScene, scene_name, "of the scene");
  PALPATE_MEMBER(TelemetryScene, image_path, "of its image");
  return table;
}
inline constexpr FieldTable kTelemetrySceneFields = fields_of_telemetry_scene();
static_assert(kTelemetrySceneFields.covers(sizeof(TelemetryScene)), "a member of TelemetryScene lacks its line here");

std::string telemetry_schema();
// Puts the schema into a region whose header has been filled, before it is shared.
void describe_telemetry(TelemetryRegion& region);

}  // namespace palpate
