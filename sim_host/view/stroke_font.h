// A small stroke font of our own (ASCII letters, digits, common signs, the micro sign), so that pictures carry text on
// a machine without any installed font.
#pragma once

#include <string_view>
#include <vector>

namespace palpate {

struct Point2 {
  double x = 0, y = 0;
};

// One pen stroke: a polyline. A dot is a stroke of two equal points.
using Stroke = std::vector<Point2>;

// Strokes of a line of UTF-8 text with its left end of the baseline at (0, 0), y downwards, for a capital height of
// 0.72 * `size` (as common fonts have). A character outside the font becomes an empty box.
std::vector<Stroke> text_strokes(std::string_view text, double size);
// Width of the same line.
double text_width(std::string_view text, double size);

}  // namespace palpate
