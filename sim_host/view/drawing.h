// A flat vector drawing: a list of lines, rectangles and texts that can be written as SVG or painted on a Canvas, so a
// plot looks the same in both.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "sim_host/view/raster.h"

namespace palpate {

class Drawing {
 public:
  Drawing(double width, double height) : width_(width), height_(height) {}
  void line(Stroke points, double line_width, Colour c, double opacity = 1);
  void rectangle(double x, double y, double width, double height, Colour c, double opacity = 1);
  void text(double x, double y, std::string text, double size, Colour c, Align align = Align::kStart,
            bool quarter_turn = false, bool bold = false);

  std::string svg() const;
  Canvas raster(double scale) const;
  // By the name's ending: .svg, or .png at twice the size. Throws std::runtime_error for another ending or on failure.
  void save(const std::string& path) const;

 private:
  struct Line {
    Stroke points;
    double width;
    Colour c;
    double opacity;
  };
  struct Rectangle {
    double x, y, width, height;
    Colour c;
    double opacity;
  };
  struct Text {
    double x, y;
    std::string text;
    double size;
    Colour c;
    Align align;
    bool quarter_turn, bold;
  };
  double width_, height_;
  std::vector<std::variant<Line, Rectangle, Text>> items_;
};

}  // namespace palpate
