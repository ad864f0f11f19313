// Sphere: one tool point, exact wherever it touches.
#include "config/tool/revolved.h"

namespace palpate {

namespace {

constexpr CardKey kSizes[] = {{"radius_mm", "radius"}};

PieceCore core(const PieceDesc& piece) { return {piece.shape, piece.touches, {0, 0, 0}, piece.radius_m, {}}; }
double reach_m(const PieceCore&) { return 0; }
std::vector<Vec3> points(const PieceCore&, std::int32_t) { return {{0, 0, 0}}; }
CoreProfile profile(const PieceCore&) { return {{{0, 0}}}; }
std::vector<SurfaceSample> samples(const PieceCore& core) { return revolved_samples(core, profile(core)); }
Indenter tip(const PieceDesc& piece) { return {TipProfile::kSphere, piece.radius_m, 0}; }

}  // namespace

extern const PieceCard sphere_piece;
const PieceCard sphere_piece{.sizes = kSizes,
                             .core = core,
                             .reach_m = reach_m,
                             .points = points,
                             .samples = samples,
                             .profile = profile,
                             .tip = tip};

}  // namespace palpate
