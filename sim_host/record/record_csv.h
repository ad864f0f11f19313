// Tick records as tables: one row per tick, and one row per contact region of every tick, as NumPy has them. Columns
// are the fields of sim_host/rings/record_fields.h, vectors one column a number; every number reads back to its own
// bits.
#pragma once

#include <optional>
#include <string>

#include "rt_core/record.h"
#include "sim_host/record/text_file.h"

namespace palpate {

class RecordCsv {
 public:
  // Either path may be empty: not written. Throws std::runtime_error when a file cannot be created.
  RecordCsv(const std::string& ticks, const std::string& regions);
  void add(const TickRecord& record);
  void finish();  // throws std::runtime_error when something could not be written

 private:
  std::optional<TextFile> ticks_, regions_;
};

}  // namespace palpate
