#include "sim_host/record/record_markdown.h"

#include <fmt/format.h>

#include "sim_host/record/recording.h"
#include "sim_host/rings/telemetry_schema.h"

namespace palpate {

namespace {

std::string type_of(const RecordField& field) {
  if (field.type[0] == 'S') return fmt::format("text[{}]", field.count);
  const char* kind = field.type[0] == 'f' ? "float" : field.type[0] == 'u' ? "uint" : "int";
  const std::string type = fmt::format("{}{}", kind, 8 * field.value_bytes());
  return field.count == 1 ? type : fmt::format("{}[{}]", type, field.count);
}

std::string table_of(const char* title, const FieldTable& fields, std::size_t bytes) {
  std::string text = fmt::format(
      "\n### {}\n{} bytes.\n\n| offset | field | type | unit | meaning |\n|---|---|---|---|---|\n", title, bytes);
  for (const RecordField& field : fields)
    text += fmt::format("| {} | `{}` | {} | {} | {} |\n", field.offset, field.name, type_of(field), field.unit,
                        field.meaning);
  return text;
}

}  // namespace

std::string record_markdown() {
  return fmt::format("Telemetry version {}, recording version {}.\n", kTelemetryVersion, plr::kVersion) +
         table_of("Tick", kTickFields, plr::kRecordPrefix) + table_of("Region", kRegionFields, sizeof(RegionRecord)) +
         table_of("Header of a recording", kRecordingHeaderFields, sizeof(RecordingHeader)) +
         table_of("Header of telemetry", kTelemetryHeaderFields, sizeof(TelemetryHeader)) +
         table_of("Later scene of a run", kTelemetrySceneFields, sizeof(TelemetryScene)) +
         fmt::format(
             "\n### Telemetry region\n{} bytes.\n\n| offset | what |\n|---|---|\n| {} | `newest`, uint64 |\n"
             "| {} | `snapshot_version`, uint64, odd while it is written; the newest record behind it |\n"
             "| {} | ring: {} slots of {} bytes, each its `sequence`, uint64, and a record of {} |\n"
             "| {} | {} later scenes of {} bytes |\n"
             "| {} | schema, text |\n",
             sizeof(TelemetryRegion), offsetof(TelemetryRegion, newest), offsetof(TelemetryRegion, snapshot_version),
             offsetof(TelemetryRegion, slot), kTelemetryCapacity, sizeof(TelemetryRegion::Slot), sizeof(TickRecord),
             offsetof(TelemetryRegion, later_scene), kMostLaterScenes, sizeof(TelemetryScene),
             offsetof(TelemetryRegion, schema));
}

}  // namespace palpate
