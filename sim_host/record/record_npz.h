// Tick records as NumPy arrays in one file: `ticks`, one row a tick, `regions`, one row for each contact region of
// every tick, and `period_ns`. Rows are the records' own bytes, their types those of sim_host/rings/record_fields.h.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "rt_core/record.h"
#include "sim_host/record/npz_file.h"

namespace palpate {

class RecordNpz {
 public:
  // Throws std::runtime_error when the file cannot be created.
  RecordNpz(const std::string& path, std::int64_t period_ns);
  void add(const TickRecord& record);
  void finish();  // throws std::runtime_error when something could not be written

 private:
  NpzFile file_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> regions_;  // until the ticks' rows end
};

}  // namespace palpate
