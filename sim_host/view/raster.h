// An RGB canvas with anti-aliased lines, rectangles and text: the pixel side of plots and picture labels.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "sim_host/view/stroke_font.h"

namespace palpate {

// Colour components 0..1 as displayed (sRGB).
struct Colour {
  float r = 0, g = 0, b = 0;
  friend bool operator==(const Colour&, const Colour&) = default;
};
// From 0xRRGGBB.
constexpr Colour colour(std::uint32_t rgb) {
  return {static_cast<float>((rgb >> 16) & 255) / 255.0f, static_cast<float>((rgb >> 8) & 255) / 255.0f,
          static_cast<float>(rgb & 255) / 255.0f};
}
inline Colour mix(Colour a, Colour b, float t) {
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

enum class Align { kStart, kMiddle, kEnd };

class Canvas {
 public:
  Canvas(int width, int height, Colour background);
  int width() const { return width_; }
  int height() const { return height_; }
  Colour pixel(int x, int y) const { return pixels_[index(x, y)]; }
  void set_pixel(int x, int y, Colour c) { pixels_[index(x, y)] = c; }
  void blend(int x, int y, Colour c, float opacity);
  // Coordinates in pixels, (0, 0) the top left corner of the top left pixel. Anything outside is cut off.
  void rectangle(double x, double y, double width, double height, Colour c, double opacity = 1);
  // Round caps and joins; where a polyline overlaps itself it is not drawn twice.
  void polyline(std::span<const Point2> points, double line_width, Colour c, double opacity = 1);
  void strokes(std::span<const Stroke> strokes, double line_width, Colour c, double opacity = 1);
  // Baseline at y. `quarter_turn`: text runs upwards.
  void text(double x, double y, std::string_view text, double size, Colour c, Align align = Align::kStart,
            bool quarter_turn = false, bool bold = false);
  // 8-bit pixels, rows from the top.
  std::vector<std::uint8_t> bytes() const;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_, height_;
  std::vector<Colour> pixels_;
};

}  // namespace palpate
