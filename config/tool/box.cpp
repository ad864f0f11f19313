// Box: tool points on a lattice of its surface.
#include <algorithm>
#include <cmath>

#include "config/scene/schema.h"
#include "config/tool/piece_card.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

constexpr CardKey kSizes[] = {{"size_mm", "outer sides"}};

double smallest_side_m(const PieceDesc& piece) { return std::min({piece.size_m.x, piece.size_m.y, piece.size_m.z}); }

Refusal check(const PieceDesc& piece) {
  if (piece.points > 0 && piece.points < 8)
    return {"points", std::to_string(piece.points) + "; a box needs its 8 corners: allowed 0 or 8 to " +
                          std::to_string(kMaxToolPoints)};
  return margin_within(piece, 0.5 * smallest_side_m(piece));
}

PieceCore core(const PieceDesc& piece) {
  const double margin = is_auto(piece.margin_m) ? smallest_side_m(piece) / 6 : piece.margin_m;
  const auto half = [margin](double side) { return 0.5 * side - margin; };
  return {piece.shape, piece.touches, {half(piece.size_m.x), half(piece.size_m.y), half(piece.size_m.z)}, margin, {}};
}
double reach_m(const PieceCore& core) {
  return norm({core.half_extent_m[0], core.half_extent_m[1], core.half_extent_m[2]});
}

// The surface of the finest lattice with at most `count` points, refined where its step is longest.
std::vector<Vec3> points(const PieceCore& core, std::int32_t count) {
  if (count == 1) return {Vec3{}};  // of a plate (rounded_solid.h)
  std::array<std::int32_t, 3> n{2, 2, 2};
  const auto surface = [](const std::array<std::int32_t, 3>& m) {
    return m[0] * m[1] * m[2] - std::max(0, m[0] - 2) * std::max(0, m[1] - 2) * std::max(0, m[2] - 2);
  };
  for (;;) {
    std::size_t longest = 3;
    for (std::size_t a = 0; a < 3; ++a) {
      std::array<std::int32_t, 3> next = n;
      ++next[a];
      if (surface(next) > count) continue;
      if (longest == 3 || core.half_extent_m[a] / (n[a] - 1) > core.half_extent_m[longest] / (n[longest] - 1))
        longest = a;
    }
    if (longest == 3) break;
    ++n[longest];
  }
  std::vector<Vec3> point;
  const auto place = [&](std::size_t a, std::int32_t i) { return core.half_extent_m[a] * (2.0 * i / (n[a] - 1) - 1); };
  for (std::int32_t i = 0; i < n[0]; ++i)
    for (std::int32_t j = 0; j < n[1]; ++j)
      for (std::int32_t k = 0; k < n[2]; ++k)
        if (i == 0 || j == 0 || k == 0 || i == n[0] - 1 || j == n[1] - 1 || k == n[2] - 1)
          point.push_back({place(0, i), place(1, j), place(2, k)});
  return point;
}

constexpr std::int32_t kBoxCells = 48;  // per side; even multiples of small lattices leave no ties
constexpr std::int32_t kBoxArc = 8;

// Offset surface of a box: for each of the 27 sign patterns, a face (one non-zero sign), edge (two) or corner (three).
void add_box_patch(const PieceCore& core, const std::array<std::int32_t, 3>& sign, std::vector<SurfaceSample>& sample) {
  const double m = core.margin_m;
  std::vector<Vec3> offset;   // of the rounding, with
  std::vector<double> share;  // its area per unit length or area of the core
  const double s[3] = {static_cast<double>(sign[0]), static_cast<double>(sign[1]), static_cast<double>(sign[2])};
  std::vector<std::size_t> bent, flat;
  for (std::size_t a = 0; a < 3; ++a) (sign[a] != 0 ? bent : flat).push_back(a);
  const auto push = [&](double u, double v, double w, double area) {
    double n[3] = {0, 0, 0};
    const double value[3] = {u, v, w};
    for (std::size_t i = 0; i < bent.size(); ++i) n[bent[i]] = s[bent[i]] * m * value[i];
    offset.push_back({n[0], n[1], n[2]});
    share.push_back(area);
  };
  const double step = 0.5 * kPi / kBoxArc;
  if (bent.size() == 1) push(1, 0, 0, 1);
  for (std::int32_t i = 0; i < kBoxArc && bent.size() >= 2; ++i) {
    const double a = (i + 0.5) * step;
    if (bent.size() == 2) push(math::cos(a), math::sin(a), 0, m * step);
    for (std::int32_t j = 0; j < kBoxArc && bent.size() == 3; ++j) {
      const double low = math::sin(j * step), high = math::sin((j + 1) * step), b = (j + 0.5) * step;
      push(math::cos(a) * math::cos(b), math::sin(a) * math::cos(b), math::sin(b), m * m * step * (high - low));
    }
  }
  const std::int32_t nu = flat.empty() ? 1 : kBoxCells, nv = flat.size() < 2 ? 1 : kBoxCells;
  for (std::int32_t i = 0; i < nu; ++i)
    for (std::int32_t j = 0; j < nv; ++j) {
      double p[3], cell = 1;
      for (std::size_t a = 0; a < 3; ++a) p[a] = s[a] * core.half_extent_m[a];
      if (!flat.empty()) {
        p[flat[0]] = core.half_extent_m[flat[0]] * ((2 * i + 1.0) / nu - 1);
        cell *= 2 * core.half_extent_m[flat[0]] / nu;
      }
      if (flat.size() == 2) {
        p[flat[1]] = core.half_extent_m[flat[1]] * ((2 * j + 1.0) / nv - 1);
        cell *= 2 * core.half_extent_m[flat[1]] / nv;
      }
      for (std::size_t k = 0; k < offset.size(); ++k)
        if (cell * share[k] > 0) sample.push_back({Vec3{p[0], p[1], p[2]} + offset[k], cell * share[k]});
    }
}

std::vector<SurfaceSample> samples(const PieceCore& core) {
  std::vector<SurfaceSample> sample;
  for (std::int32_t x = -1; x <= 1; ++x)
    for (std::int32_t y = -1; y <= 1; ++y)
      for (std::int32_t z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0) add_box_patch(core, {x, y, z}, sample);
  return sample;
}

std::vector<Vec3> corners(const PieceCore& core) {
  const double* half = core.half_extent_m;
  std::vector<Vec3> corner;
  for (unsigned k = 0; k < 8; ++k)
    corner.push_back({(k & 1) ? half[0] : -half[0], (k & 2) ? half[1] : -half[1], (k & 4) ? half[2] : -half[2]});
  return corner;
}

}  // namespace

extern const PieceCard box_piece;
const PieceCard box_piece{.sizes = kSizes,
                          .margin = "rounding, part of the outer size; auto: a third of the smallest half side",
                          .check = check,
                          .core = core,
                          .reach_m = reach_m,
                          .points = points,
                          .samples = samples,
                          .corners = corners};

}  // namespace palpate
