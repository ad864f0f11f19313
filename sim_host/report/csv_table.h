// A table of numbers with named columns, as measurements and this project's own programs write them. Cells that are no
// number are NaN; columns of text may stand beside those that are read.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace palpate {

struct CsvTable {
  std::string file;
  std::vector<std::string> name;             // of the columns, in order
  std::vector<std::vector<double>> values;   // of each column, one per row
  std::map<std::string, std::string> notes;  // lines "# key = value"
  std::size_t rows() const { return values.empty() ? 0 : values[0].size(); }
  bool has(const std::string& column) const;
  // Throws std::runtime_error naming the file, the column and those that are there.
  const std::vector<double>& column(const std::string& column) const;
  // Empty when there is none.
  std::string note(const std::string& key) const;
};

// Throws std::runtime_error "FILE:LINE: what is wrong".
CsvTable read_csv_table(const std::string& path);

}  // namespace palpate
