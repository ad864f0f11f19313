#include "sim_host/report/csv_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "sim_host/csv_cells.h"

namespace palpate {

namespace {

double number_of(std::string_view cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool whole = error == std::errc() && end == cell.data() + cell.size();
  return whole ? value : std::numeric_limits<double>::quiet_NaN();
}

void add_note(std::string_view line, CsvTable& table) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) return;
  table.notes[std::string(trimmed(line.substr(1, equals - 1)))] = std::string(trimmed(line.substr(equals + 1)));
}

}  // namespace

bool CsvTable::has(const std::string& column) const { return std::ranges::find(name, column) != name.end(); }

const std::vector<double>& CsvTable::column(const std::string& column) const {
  const auto found = std::ranges::find(name, column);
  if (found == name.end())
    throw std::runtime_error(fmt::format("{}: no column {}; there are {}", file, column, fmt::join(name, ", ")));
  return values[static_cast<std::size_t>(found - name.begin())];
}

std::string CsvTable::note(const std::string& key) const {
  const auto found = notes.find(key);
  return found == notes.end() ? "" : found->second;
}

CsvTable read_csv_table(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error(path + ": cannot open");
  CsvTable table;
  table.file = path;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (trimmed(line).empty()) continue;
    if (line[0] == '#') {
      add_note(line, table);
      continue;
    }
    const std::vector<std::string_view> cells = cells_of(line);
    if (table.name.empty()) {
      table.name.assign(cells.begin(), cells.end());
      table.values.resize(cells.size());
      continue;
    }
    if (cells.size() != table.name.size())
      throw std::runtime_error(
          fmt::format("{}:{}: {} cells, the header has {}", path, number, cells.size(), table.name.size()));
    for (std::size_t i = 0; i < cells.size(); ++i) table.values[i].push_back(number_of(cells[i]));
  }
  if (table.rows() == 0) throw std::runtime_error(path + ": no rows below a header of column names");
  return table;
}

}  // namespace palpate
