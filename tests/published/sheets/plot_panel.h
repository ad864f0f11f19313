// A small plot with its names inside, and the tables it is drawn from.
#pragma once

#include <string>
#include <vector>

#include "sim_host/view/line_plot.h"
#include "tests/published/sheets/sheet.h"

namespace palpate::papers {

// The columns of a CSV with a header row, by their names; cells that are no number are 0.
class Table {
 public:
  explicit Table(const std::string& path);
  // Throws std::runtime_error naming the file when there is no such column.
  const std::vector<double>& operator[](const std::string& column) const;

 private:
  std::string path_;
  std::vector<std::string> name_;
  std::vector<std::vector<double>> column_;
};

std::vector<double> scaled(const std::vector<double>& values, double factor, double plus = 0);

enum class PlotKind { kLines, kMarks, kBars };
// The y axis starts at 0 or at the lowest value below it; marks: points alone.
Canvas plot_panel(const std::vector<PlotCurve>& curves, const std::string& x_title, const std::string& y_title,
                  PlotKind kind = PlotKind::kLines);

}  // namespace palpate::papers
