#include "sim_host/view/picture_foot.h"

#include <algorithm>
#include <cmath>

#include "sim_host/view/plot.h"
#include "sim_host/view/world_axes.h"

namespace palpate {

namespace {

constexpr Colour kInk = colour(0x1f2933), kArrow = colour(0x1b74c4);

void axes(Canvas& canvas, const Projection& projection, double x, double y, double unit) {
  for (const WorldAxis& a : world_axes(projection)) {
    canvas.polyline(Stroke{{x, y}, {x + 34 * unit * a.right, y + 34 * unit * a.down}}, 2.4 * unit, a.colour);
    canvas.text(x + 46 * unit * a.right, y + (46 * a.down + 5) * unit, a.name, 15 * unit, a.colour, Align::kMiddle,
                false, true);
  }
}

}  // namespace

void draw_foot(Canvas& canvas, const Projection& projection, double m_per_pixel, const ForceScale& forces) {
  const double unit = canvas.height() / 900.0, base = canvas.height() - 30 * unit, above = base - 14 * unit;
  axes(canvas, projection, 64 * unit, base - 24 * unit, unit);
  const double bar_m = round_below(140 * unit * m_per_pixel), bar = bar_m / m_per_pixel;
  double x = 150 * unit;
  for (const double end : {x, x + bar})
    canvas.polyline(Stroke{{end, base - 5 * unit}, {end, base + 5 * unit}}, 1.6 * unit, kInk);
  canvas.polyline(Stroke{{x, base}, {x + bar, base}}, 1.6 * unit, kInk);
  canvas.text(x, above, tick_label(1e3 * bar_m) + " mm", 15 * unit, kInk);
  x += std::max(bar, 80 * unit) + 50 * unit;
  const double arrow = forces.reference_N * forces.m_per_N / m_per_pixel, head = std::min(0.5 * arrow, 12 * unit);
  canvas.polyline(Stroke{{x, base}, {x + arrow - head, base}}, 5 * unit, kArrow);
  // The head in columns of pixels: a canvas knows no triangle.
  const double tip = x + arrow;
  for (double at = std::floor(tip - head); at < tip; ++at)
    canvas.rectangle(at, base - 6.5 * unit * (tip - at) / head, 1, 13 * unit * (tip - at) / head, kArrow);
  canvas.text(x, above, tick_label(forces.reference_N) + " N on the tool", 15 * unit, kInk);
}

}  // namespace palpate
