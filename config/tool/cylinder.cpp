// Cylinder: tool points on its ends and in rings around it; its tip is a flat punch.
#include <algorithm>
#include <cmath>

#include "config/scene/schema.h"
#include "config/tool/revolved.h"

namespace palpate {

namespace {

constexpr CardKey kSizes[] = {{"radius_mm", "outer radius"}, {"length_mm", "overall length"}};

Refusal check(const PieceDesc& piece) { return margin_within(piece, std::min(piece.radius_m, 0.5 * piece.length_m)); }

PieceCore core(const PieceDesc& piece) {
  PieceCore core{piece.shape, piece.touches, {0, 0, 0}, piece.margin_m, {}};
  if (is_auto(core.margin_m)) core.margin_m = std::min(piece.radius_m, 0.5 * piece.length_m) / 3;
  core.half_extent_m[0] = core.half_extent_m[1] = piece.radius_m - core.margin_m;
  core.half_extent_m[2] = 0.5 * piece.length_m - core.margin_m;
  return core;
}
double reach_m(const PieceCore& core) { return std::hypot(core.half_extent_m[0], core.half_extent_m[2]); }
std::vector<Vec3> points(const PieceCore& core, std::int32_t count) { return revolved_points(core, count, false); }

CoreProfile profile(const PieceCore& core) {
  const double r = core.half_extent_m[0], h = core.half_extent_m[2];
  return {{{0, -h}, {r, -h}, {r, h}, {0, h}}};
}
std::vector<SurfaceSample> samples(const PieceCore& core) { return revolved_samples(core, profile(core)); }
Indenter tip(const PieceDesc& piece) { return {TipProfile::kFlat, piece.radius_m, 0}; }

}  // namespace

extern const PieceCard cylinder_piece;
const PieceCard cylinder_piece{.sizes = kSizes,
                               .margin = "rounding, part of the outer size; auto: a third of the smallest half size",
                               .has_ends = true,
                               .check = check,
                               .core = core,
                               .reach_m = reach_m,
                               .points = points,
                               .samples = samples,
                               .profile = profile,
                               .tip = tip,
                               .check_tip = needs_one_end};

}  // namespace palpate
