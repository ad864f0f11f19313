#include "sim_host/view/drawing.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "sim_host/view/png_file.h"

namespace palpate {

namespace {

std::string hex(Colour c) {
  const auto byte = [](float v) { return std::lround(v * 255.0f); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b));
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string opacity_attribute(double opacity) { return opacity < 1 ? fmt::format(" opacity=\"{:.3g}\"", opacity) : ""; }

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

}  // namespace

void Drawing::line(Stroke points, double line_width, Colour c, double opacity) {
  items_.emplace_back(Line{std::move(points), line_width, c, opacity});
}
void Drawing::rectangle(double x, double y, double width, double height, Colour c, double opacity) {
  items_.emplace_back(Rectangle{x, y, width, height, c, opacity});
}
void Drawing::text(double x, double y, std::string text, double size, Colour c, Align align, bool quarter_turn,
                   bool bold) {
  items_.emplace_back(Text{x, y, std::move(text), size, c, align, quarter_turn, bold});
}

std::string Drawing::svg() const {
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.6g}\" "
      "height=\"{1:.6g}\" viewBox=\"0 0 {0:.6g} {1:.6g}\" font-family=\"Helvetica, Arial, 'DejaVu Sans', "
      "sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
      width_, height_);
  const Overloaded write{
      [&out](const Line& line) {
        out += fmt::format(
            "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{:.3g}\" stroke-linejoin=\"round\"{} "
            "points=\"",
            hex(line.c), line.width, opacity_attribute(line.opacity));
        for (const Point2 p : line.points) out += fmt::format("{:.2f},{:.2f} ", p.x, p.y);
        out += "\"/>\n";
      },
      [&out](const Rectangle& r) {
        out += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"{}/>\n", r.x,
                           r.y, r.width, r.height, hex(r.c), opacity_attribute(r.opacity));
      },
      [&out](const Text& t) {
        static constexpr const char* kAnchor[] = {"start", "middle", "end"};
        const std::string turn =
            t.quarter_turn ? fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", t.x, t.y) : "";
        out += fmt::format(
            "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.3g}\" fill=\"{}\" text-anchor=\"{}\"{}{}>{}"
            "</text>\n",
            t.x, t.y, t.size, hex(t.c), kAnchor[static_cast<int>(t.align)], t.bold ? " font-weight=\"bold\"" : "", turn,
            escaped(t.text));
      }};
  for (const auto& item : items_) std::visit(write, item);
  return out + "</svg>\n";
}

Canvas Drawing::raster(double scale) const {
  Canvas canvas(static_cast<int>(std::lround(width_ * scale)), static_cast<int>(std::lround(height_ * scale)),
                colour(0xffffff));
  const Overloaded paint{
      [&](const Line& line) {
        Stroke scaled = line.points;
        for (Point2& p : scaled) p = {p.x * scale, p.y * scale};
        canvas.polyline(scaled, line.width * scale, line.c, line.opacity);
      },
      [&](const Rectangle& r) {
        canvas.rectangle(r.x * scale, r.y * scale, r.width * scale, r.height * scale, r.c, r.opacity);
      },
      [&](const Text& t) {
        canvas.text(t.x * scale, t.y * scale, t.text, t.size * scale, t.c, t.align, t.quarter_turn, t.bold);
      }};
  for (const auto& item : items_) std::visit(paint, item);
  return canvas;
}

void Drawing::save(const std::string& path) const {
  if (path.ends_with(".png")) {
    const Canvas canvas = raster(2.0);
    write_png(path, canvas.width(), canvas.height(), canvas.bytes());
    return;
  }
  if (!path.ends_with(".svg")) throw std::runtime_error(path + ": a plot is written as .svg or .png");
  std::ofstream file(path, std::ios::binary);
  file << svg();
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot write");
}

}  // namespace palpate
