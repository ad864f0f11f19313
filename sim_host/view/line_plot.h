// A plot of named curves over one axis.
#pragma once

#include <string>
#include <vector>

#include "sim_host/view/drawing.h"

namespace palpate {

struct PlotCurve {
  std::string name;
  std::vector<double> x, y;  // equally long, x rising
};

struct PlotText {
  std::string title, x_title, y_title;
};

// Lines through the points; with `marks` also a dot at each; the names stand at the right. The y axis starts at 0 or at
// the lowest value below it. A curve that lies on an earlier one is dashed.
Drawing line_plot(const std::vector<PlotCurve>& curves, const PlotText& text, bool marks);
// A bar for each value, those of one x beside one another: for what has no between, as anchors. x: 1, 2, ... of groups.
Drawing bar_plot(const std::vector<PlotCurve>& series, const PlotText& text);

}  // namespace palpate
