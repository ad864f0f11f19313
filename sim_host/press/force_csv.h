// The table `palpate press` writes: one row per tool pose. Columns: docs/press.md.
#pragma once

#include <cstdio>
#include <string>

#include "sim_host/press/press.h"

namespace palpate {

// Regions with columns of their own; further ones are listed in the last column.
inline constexpr int kRegionColumns = 4;

// First row: the names of the columns, with units. No line break at the end.
std::string force_csv_header();
std::string force_csv_row(const PressRow& row);

// Writes both to a file; throws std::runtime_error when it cannot.
class ForceCsv {
 public:
  explicit ForceCsv(const std::string& path);
  ~ForceCsv();
  ForceCsv(const ForceCsv&) = delete;
  ForceCsv& operator=(const ForceCsv&) = delete;
  void add(const PressRow& row);
  // Closes the file and checks that everything reached it.
  void finish();

 private:
  std::string path_;
  std::FILE* file_;
};

}  // namespace palpate
