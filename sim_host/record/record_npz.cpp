#include "sim_host/record/record_npz.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <vector>

#include "sim_host/rings/record_fields.h"

namespace palpate {

namespace {

constexpr std::size_t kTickBytes = offsetof(TickRecord, region);
constexpr char kOfTick[] = "('sequence', '<u8'), ('tick', '<u8'), ";  // what a region's row begins with

// The fields of a table as Python writes the type of a row; what is reserved is padding.
std::string fields_of(const FieldTable& table) {
  std::string text;
  for (const RecordField& field : table) {
    if (field.is_reserved())
      text += fmt::format("('', '|V{}'), ", field.end() - field.offset);
    else if (field.count == 1)
      text += fmt::format("('{}', '<{}'), ", field.name, field.type);
    else
      text += fmt::format("('{}', '<{}', ({},)), ", field.name, field.type, field.count);
  }
  return text;
}

}  // namespace

RecordNpz::RecordNpz(const std::string& path, std::int64_t period_ns)
    : file_(path), regions_(std::tmpfile(), std::fclose) {
  if (!regions_) throw std::runtime_error(path + ": no place for a temporary file");
  file_.begin("period_ns", "'<i8'", sizeof period_ns);
  file_.write(std::as_bytes(std::span(&period_ns, 1)));
  file_.end();
  file_.begin("ticks", "[" + fields_of(kTickFields) + "]", kTickBytes);
}

void RecordNpz::add(const TickRecord& record) {
  file_.write(std::as_bytes(std::span(&record, 1)).first(kTickBytes));
  for (std::int32_t i = 0; i < record.region_count && i < kMaxRegions; ++i) {
    const std::array<std::uint64_t, 2> of_tick{record.sequence, record.tick};
    std::fwrite(of_tick.data(), 1, sizeof of_tick, regions_.get());
    std::fwrite(&record.region[i], 1, sizeof record.region[i], regions_.get());
  }
}

void RecordNpz::finish() {
  file_.end();
  file_.begin("regions", std::string("[") + kOfTick + fields_of(kRegionFields) + "]",
              2 * sizeof(std::uint64_t) + sizeof(RegionRecord));
  const bool written = std::fflush(regions_.get()) == 0 && std::ferror(regions_.get()) == 0;
  std::rewind(regions_.get());
  std::vector<std::byte> block(1 << 16);
  for (std::size_t read; (read = std::fread(block.data(), 1, block.size(), regions_.get())) > 0;)
    file_.write(std::span(block).first(read));
  file_.end();
  file_.finish();
  if (!written || std::ferror(regions_.get()) != 0)
    throw std::runtime_error("the temporary file of the regions cannot be written or read: is its disk full?");
}

}  // namespace palpate
