// Capsule: tool points along its axis.
#include <algorithm>
#include <cmath>

#include "config/tool/revolved.h"

namespace palpate {

namespace {

constexpr CardKey kSizes[] = {{"radius_mm", "radius"}, {"length_mm", "overall length, round ends included"}};

Refusal check(const PieceDesc& piece) {
  if (piece.length_m >= 2 * piece.radius_m) return {};
  return {"length_mm", "shorter than twice the radius; a capsule's length includes its round ends"};
}

PieceCore core(const PieceDesc& piece) {
  const double half = std::max(0.0, 0.5 * piece.length_m - piece.radius_m);
  return {piece.shape, piece.touches, {piece.end_left[0], piece.end_left[1], half}, piece.radius_m, {}};
}
double reach_m(const PieceCore& core) { return core.half_extent_m[2]; }

std::vector<Vec3> points(const PieceCore& core, std::int32_t count) {
  const double h = core.half_extent_m[2];
  if (core.touches == TouchingEnd::kPlusZ) return {{0, 0, h}};
  if (core.touches == TouchingEnd::kMinusZ) return {{0, 0, -h}};
  if (count == 1 || h == 0) return {{0, 0, 0}};
  std::vector<Vec3> point;
  for (std::int32_t k = 0; k < count; ++k) point.push_back({0, 0, h * (2.0 * k / (count - 1) - 1)});
  return point;
}

CoreProfile profile(const PieceCore& core) { return {{{0, -core.half_extent_m[2]}, {0, core.half_extent_m[2]}}}; }
std::vector<SurfaceSample> samples(const PieceCore& core) { return revolved_samples(core, profile(core)); }
Indenter tip(const PieceDesc& piece) { return {TipProfile::kSphere, piece.radius_m, 0}; }

}  // namespace

extern const PieceCard capsule_piece;
const PieceCard capsule_piece{.sizes = kSizes,
                              .has_ends = true,
                              .check = check,
                              .core = core,
                              .reach_m = reach_m,
                              .points = points,
                              .samples = samples,
                              .profile = profile,
                              .tip = tip,
                              .check_tip = needs_one_end,
                              .has_side_tip = true};

}  // namespace palpate
