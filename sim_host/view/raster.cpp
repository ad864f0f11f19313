#include "sim_host/view/raster.h"

#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

double distance_to_segment(double px, double py, Point2 a, Point2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double t = squared > 0 ? std::clamp(((px - a.x) * dx + (py - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(px - a.x - t * dx, py - a.y - t * dy);
}

int clamp_pixel(double x, int limit) { return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(limit))); }

}  // namespace

Canvas::Canvas(int width, int height, Colour background)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background) {}

void Canvas::blend(int x, int y, Colour c, float opacity) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  Colour& old = pixels_[index(x, y)];
  old = mix(old, c, opacity);
}

void Canvas::rectangle(double x, double y, double width, double height, Colour c, double opacity) {
  const int x1 = clamp_pixel(std::ceil(x + width), width_), y1 = clamp_pixel(std::ceil(y + height), height_);
  for (int row = clamp_pixel(std::floor(y), height_); row < y1; ++row) {
    const double cover_y = std::min(row + 1.0, y + height) - std::max<double>(row, y);
    for (int column = clamp_pixel(std::floor(x), width_); column < x1; ++column) {
      const double cover_x = std::min(column + 1.0, x + width) - std::max<double>(column, x);
      blend(column, row, c, static_cast<float>(opacity * cover_x * cover_y));
    }
  }
}

void Canvas::polyline(std::span<const Point2> points, double line_width, Colour c, double opacity) {
  const Stroke one(points.begin(), points.end());
  strokes(std::span<const Stroke>(&one, 1), line_width, c, opacity);
}

void Canvas::strokes(std::span<const Stroke> all, double line_width, Colour c, double opacity) {
  double left = 1e30, top = 1e30, right = -1e30, bottom = -1e30;
  for (const Stroke& stroke : all) {
    for (const Point2 p : stroke) {
      left = std::min(left, p.x), right = std::max(right, p.x);
      top = std::min(top, p.y), bottom = std::max(bottom, p.y);
    }
  }
  const double reach = 0.5 * line_width + 1;
  const int x0 = clamp_pixel(left - reach, width_), x1 = clamp_pixel(right + reach + 1, width_);
  const int y0 = clamp_pixel(top - reach, height_), y1 = clamp_pixel(bottom + reach + 1, height_);
  if (x0 >= x1 || y0 >= y1) return;
  const auto mask_width = static_cast<std::size_t>(x1 - x0);
  std::vector<float> mask(mask_width * static_cast<std::size_t>(y1 - y0), 0.0f);
  const auto cover = [&](Point2 a, Point2 b) {
    const int sx0 = std::max(x0, clamp_pixel(std::min(a.x, b.x) - reach, width_));
    const int sx1 = std::min(x1, clamp_pixel(std::max(a.x, b.x) + reach + 1, width_));
    const int sy0 = std::max(y0, clamp_pixel(std::min(a.y, b.y) - reach, height_));
    const int sy1 = std::min(y1, clamp_pixel(std::max(a.y, b.y) + reach + 1, height_));
    for (int y = sy0; y < sy1; ++y) {
      for (int x = sx0; x < sx1; ++x) {
        const double inside = 0.5 * line_width + 0.5 - distance_to_segment(x + 0.5, y + 0.5, a, b);
        if (!(inside > 0)) continue;
        float& cell = mask[static_cast<std::size_t>(y - y0) * mask_width + static_cast<std::size_t>(x - x0)];
        cell = std::max(cell, static_cast<float>(std::min(inside, std::min(1.0, line_width))));
      }
    }
  };
  for (const Stroke& stroke : all) {
    for (std::size_t i = 0; i + 1 < stroke.size(); ++i) cover(stroke[i], stroke[i + 1]);
  }
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const float m = mask[static_cast<std::size_t>(y - y0) * mask_width + static_cast<std::size_t>(x - x0)];
      if (m > 0) blend(x, y, c, m * static_cast<float>(opacity));
    }
  }
}

void Canvas::text(double x, double y, std::string_view text, double size, Colour c, Align align, bool quarter_turn,
                  bool bold) {
  const double shift = align == Align::kStart ? 0.0 : text_width(text, size) * (align == Align::kEnd ? 1.0 : 0.5);
  std::vector<Stroke> lines = text_strokes(text, size);
  for (Stroke& stroke : lines) {
    for (Point2& p : stroke) {
      const Point2 q{p.x - shift, p.y};
      p = quarter_turn ? Point2{x + q.y, y - q.x} : Point2{x + q.x, y + q.y};
    }
  }
  strokes(lines, size * (bold ? 0.125 : 0.085), c);
}

std::vector<std::uint8_t> Canvas::bytes() const {
  std::vector<std::uint8_t> out;
  out.reserve(pixels_.size() * 3);
  for (const Colour& p : pixels_) {
    for (const float v : {p.r, p.g, p.b}) {
      out.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255.0f)));
    }
  }
  return out;
}

}  // namespace palpate
