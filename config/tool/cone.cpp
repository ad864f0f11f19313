// Cone, its apex at +z: tool points on its base, in rings and at the apex, which is its tip.
#include <algorithm>
#include <cmath>

#include "config/tool/revolved.h"

namespace palpate {

namespace {

constexpr CardKey kSizes[] = {{"radius_mm", "radius of the core's base"}, {"length_mm", "height of the core"}};

PieceCore core(const PieceDesc& piece) {
  return {piece.shape,
          piece.touches,
          {piece.radius_m, piece.radius_m, 0.5 * piece.length_m},
          is_auto(piece.margin_m) ? 2e-3 : piece.margin_m,
          {}};
}
double reach_m(const PieceCore& core) { return std::hypot(core.half_extent_m[0], core.half_extent_m[2]); }
std::vector<Vec3> points(const PieceCore& core, std::int32_t count) { return revolved_points(core, count, true); }

CoreProfile profile(const PieceCore& core) {
  const double r = core.half_extent_m[0], h = core.half_extent_m[2];
  return {{{0, -h}, {r, -h}, {0, h}}};
}
std::vector<SurfaceSample> samples(const PieceCore& core) { return revolved_samples(core, profile(core)); }

Indenter tip(const PieceDesc& piece) { return {TipProfile::kCone, 0, piece.radius_m / piece.length_m}; }
Refusal check_tip(const PieceDesc& piece) {
  if (piece.touches == TouchingEnd::kPlusZ) return {};
  return {"touches", "a cone presses with its apex; set touches = \"plus_z\""};
}

}  // namespace

extern const PieceCard cone_piece;
const PieceCard cone_piece{.sizes = kSizes,
                           .margin = "rounding, added to the core; auto: 2 mm",
                           .has_ends = true,
                           .core = core,
                           .reach_m = reach_m,
                           .points = points,
                           .samples = samples,
                           .profile = profile,
                           .tip = tip,
                           .check_tip = check_tip};

}  // namespace palpate
