// Torus about z: tool points on its circle. A ring, a loop of wire, a finger's eyelet.
#include "config/tool/revolved.h"

namespace palpate {

namespace {

constexpr CardKey kSizes[] = {{"radius_mm", "outer radius"}};

// The hole must stay open.
Refusal check(const PieceDesc& piece) { return margin_within(piece, 0.5 * piece.radius_m); }

PieceCore core(const PieceDesc& piece) {
  const double margin = is_auto(piece.margin_m) ? 0.25 * piece.radius_m : piece.margin_m;
  const double circle = piece.radius_m - margin;
  return {piece.shape, piece.touches, {circle, circle, 0}, margin, {}};
}
double reach_m(const PieceCore& core) { return core.half_extent_m[0]; }
std::vector<Vec3> points(const PieceCore& core, std::int32_t count) {
  std::vector<Vec3> point;
  add_ring(point, core.half_extent_m[0], 0, count, 0);
  return point;
}
CoreProfile profile(const PieceCore& core) { return {{{core.half_extent_m[0], 0}}, true}; }
std::vector<SurfaceSample> samples(const PieceCore& core) { return revolved_samples(core, profile(core)); }

}  // namespace

extern const PieceCard torus_piece;
const PieceCard torus_piece{.sizes = kSizes,
                            .margin = "radius of the tube, part of the outer size; auto: a quarter of it",
                            .check = check,
                            .core = core,
                            .reach_m = reach_m,
                            .points = points,
                            .samples = samples,
                            .profile = profile};

}  // namespace palpate
