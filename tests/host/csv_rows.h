// A CSV table as its rows, cells by the names of their columns.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace palpate::test {

using CsvRow = std::map<std::string, std::string>;

inline std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

inline std::vector<CsvRow> csv_rows(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = csv_cells(line);
  std::vector<CsvRow> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> values = csv_cells(line);
    EXPECT_EQ(values.size(), names.size()) << line;
    CsvRow row;
    for (std::size_t i = 0; i < names.size() && i < values.size(); ++i)
      EXPECT_TRUE(row.emplace(names[i], values[i]).second) << names[i] << " twice";
    rows.push_back(row);
  }
  return rows;
}

}  // namespace palpate::test
