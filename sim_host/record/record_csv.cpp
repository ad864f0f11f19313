#include "sim_host/record/record_csv.h"

#include <fmt/format.h>

#include <cstring>
#include <iterator>

#include "sim_host/rings/record_fields.h"

namespace palpate {

namespace {

constexpr char kOfTick[] = "sequence,tick";  // what a region's row begins with

// device_force_N_x, tool_orientation_w, stage_ns_0.
std::string columns(const FieldTable& table) {
  std::string text;
  for (const RecordField& field : table) {
    if (field.is_reserved()) continue;
    const char* parts = field.count == 3 ? "xyz" : field.count == 4 ? "wxyz" : nullptr;
    for (std::uint32_t i = 0; i < field.count; ++i) {
      text += fmt::format("{}{}", text.empty() ? "" : ",", field.name);
      if (field.count > 1) text += parts != nullptr ? fmt::format("_{}", parts[i]) : fmt::format("_{}", i);
    }
  }
  return text;
}

template <class T>
void put_value(std::string& row, const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  fmt::format_to(std::back_inserter(row), "{}", value);  // fmt: the shortest text that reads back to these bits
}

void put_value(std::string& row, const RecordField& field, const std::byte* at) {
  const std::string_view type = field.type;
  if (type == "f8") put_value<double>(row, at);
  if (type == "f4") put_value<float>(row, at);
  if (type == "u8") put_value<std::uint64_t>(row, at);
  if (type == "i8") put_value<std::int64_t>(row, at);
  if (type == "u4") put_value<std::uint32_t>(row, at);
  if (type == "i4") put_value<std::int32_t>(row, at);
}

std::string values(const FieldTable& table, const void* record) {
  const auto* bytes = static_cast<const std::byte*>(record);
  std::string row;
  for (const RecordField& field : table) {
    if (field.is_reserved()) continue;
    for (std::uint32_t i = 0; i < field.count; ++i) {
      if (!row.empty()) row += ',';
      put_value(row, field, bytes + field.offset + i * field.value_bytes());
    }
  }
  return row;
}

}  // namespace

RecordCsv::RecordCsv(const std::string& ticks, const std::string& regions) {
  if (!ticks.empty()) ticks_.emplace(ticks).write(columns(kTickFields) + '\n');
  if (!regions.empty()) regions_.emplace(regions).write(fmt::format("{},{}\n", kOfTick, columns(kRegionFields)));
}

void RecordCsv::add(const TickRecord& record) {
  if (ticks_) ticks_->write(values(kTickFields, &record) + '\n');
  for (std::int32_t i = 0; regions_ && i < record.region_count && i < kMaxRegions; ++i)
    regions_->write(fmt::format("{},{},{}\n", record.sequence, record.tick, values(kRegionFields, &record.region[i])));
}

void RecordCsv::finish() {
  if (ticks_) ticks_->finish();
  if (regions_) regions_->finish();
}

}  // namespace palpate
