// Tick records as a table: one row per tick, SI units, columns named in the first row.
#pragma once

#include <cstdio>
#include <string>

#include "rt_core/record.h"

namespace palpate {

class RecordCsv {
 public:
  // Throws std::runtime_error when the file cannot be created.
  explicit RecordCsv(const std::string& path);
  ~RecordCsv();
  RecordCsv(const RecordCsv&) = delete;
  RecordCsv& operator=(const RecordCsv&) = delete;
  void add(const TickRecord& record);

 private:
  std::FILE* file_;
};

}  // namespace palpate
