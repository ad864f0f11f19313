#include "sim_host/python/record_arrays.h"

#include <cstddef>
#include <cstring>
#include <string>

#include "sim_host/rings/record_fields.h"

namespace palpate {

namespace py = pybind11;

namespace {

struct RegionRow {
  std::uint64_t sequence, tick;
  RegionRecord region;
};
constexpr std::size_t kTickBytes = offsetof(TickRecord, region);

// The fields of a table as NumPy's; `base`: bytes before it in a row.
void add_to(py::list& names, py::list& formats, py::list& offsets, const FieldTable& table, std::size_t base) {
  for (const RecordField& field : table) {
    if (field.is_reserved()) continue;
    names.append(field.name);
    const std::string type = std::string("<") + field.type;
    formats.append(field.count == 1 ? type : "(" + std::to_string(field.count) + ",)" + type);
    offsets.append(base + field.offset);
  }
}

// What a region's row has before the region: of which tick it is.
constexpr FieldTable fields_of_row() {
  FieldTable table;
  constexpr std::size_t base = 0;
  PALPATE_MEMBER(RegionRow, sequence, "of the tick");
  PALPATE_MEMBER(RegionRow, tick, "number of the tick since the reset");
  return table;
}
constexpr FieldTable kRowFields = fields_of_row();
static_assert(kRowFields.covers(offsetof(RegionRow, region)));

void add_meanings(py::list& list, const FieldTable& table) {
  for (const RecordField& field : table)
    if (!field.is_reserved()) list.append(py::make_tuple(field.name, field.meaning));
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

py::dtype tick_dtype() {
  py::list names, formats, offsets;
  add_to(names, formats, offsets, kTickFields, 0);
  return {names, formats, offsets, static_cast<py::ssize_t>(kTickBytes)};
}
py::dtype region_dtype() {
  py::list names, formats, offsets;
  add_to(names, formats, offsets, kRowFields, 0);
  add_to(names, formats, offsets, kRegionFields, offsetof(RegionRow, region));
  return {names, formats, offsets, static_cast<py::ssize_t>(sizeof(RegionRow))};
}
py::list tick_fields() {
  py::list list;
  add_meanings(list, kTickFields);
  return list;
}
py::list region_fields() {
  py::list list;
  add_meanings(list, kRowFields);
  add_meanings(list, kRegionFields);
  return list;
}

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
