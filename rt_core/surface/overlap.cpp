#include "rt_core/surface/overlap.h"

#include <ccd/ccd.h>

#include "rt_core/surface/triangle.h"
#include "rt_core/tool/shapes.h"

namespace palpate {

namespace {

// libccd's tolerances are absolute and meant for lengths near 1: in metres it misjudges hundreds of pairs in 100,000,
// in millimetres one at most (measured on libccd 2.1, 2026-11-21).
constexpr Real kMillimetresPerMetre = 1000;
// Distance of the point returned once the budget is spent: beyond every scene, so that the search sees two sets that
// cannot meet and stops.
constexpr Real kFarAway_mm = 1e9;

// What the callbacks need. Both objects of a pair share it, so that the calls of both are counted together.
struct Pair {
  const ToolPiece* piece;
  std::span<const Vec3> hull;
  Vec3 triangle_mm[3];  // piece frame
  std::int32_t calls, budget;
};

Vec3 from_ccd(const ccd_vec3_t& v) PALPATE_RT { return {v.v[0], v.v[1], v.v[2]}; }
void to_ccd(Vec3 from, ccd_vec3_t& to) PALPATE_RT {
  to.v[0] = from.x;
  to.v[1] = from.y;
  to.v[2] = from.z;
}

// Counts the call and says whether the shape should still be asked. Once the budget is spent, or the direction is
// unusable, `out` is a point far against the direction.
bool spend(Pair& pair, Vec3 direction, Vec3& unit, ccd_vec3_t& out) PALPATE_RT {
  pair.calls += 1;
  unit = unit_or(direction, {});
  if (pair.calls <= pair.budget && squared_norm(unit) > 0) return true;
  to_ccd(-kFarAway_mm * (squared_norm(unit) > 0 ? unit : Vec3{1, 0, 0}), out);
  pair.calls = pair.calls <= pair.budget ? pair.budget + 1 : pair.calls;
  return false;
}

// libccd hands the objects back as const void*; the counter behind them is ours to write.
Pair& pair_of(const void* object) PALPATE_RT { return *const_cast<Pair*>(static_cast<const Pair*>(object)); }

void piece_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) PALPATE_RT {
  Pair& pair = pair_of(object);
  Vec3 unit;
  if (!spend(pair, from_ccd(*direction), unit, *out)) return;
  const Vec3 point_m = core_support(*pair.piece, pair.hull, unit) + pair.piece->margin_m * unit;
  to_ccd(kMillimetresPerMetre * point_m, *out);
}

void triangle_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) PALPATE_RT {
  Pair& pair = pair_of(object);
  Vec3 unit;
  if (!spend(pair, from_ccd(*direction), unit, *out)) return;
  const Vec3* t = pair.triangle_mm;
  const Real a = dot(t[0], unit), b = dot(t[1], unit), c = dot(t[2], unit);
  to_ccd(a >= b && a >= c ? t[0] : b >= c ? t[1] : t[2], *out);
}

// First direction: from the triangle's centre to the piece's; never zero.
void first_direction(const void* object, const void*, ccd_vec3_t* out) PALPATE_RT {
  const Vec3* t = pair_of(object).triangle_mm;
  to_ccd(unit_or(-(t[0] + t[1] + t[2]), {1, 0, 0}), *out);
}

int intersect(Pair& pair) PALPATE_RT {
  ccd_t ccd{};  // filled by hand: CCD_INIT leaves max_iterations unlimited
  ccd.first_dir = first_direction;
  ccd.support1 = piece_support;
  ccd.support2 = triangle_support;
  ccd.max_iterations = kGjkMaxIterations;
  // ccdGJKIntersect is C and carries no effect annotation. It neither allocates nor blocks (read in libccd 2.1's ccd.c,
  // and checked by the allocation tests); its loop is bounded by max_iterations and by the callbacks' budget.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
  return ccdGJKIntersect(&pair, &pair, &ccd);
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif
}

// What the closed form takes, in supports.
constexpr std::int32_t kClosedFormSupports = kLeastSupports;

// Squared distance of a triangle from the segment of length 2 `half` along z about the origin. Where they do not meet
// the nearest two points are an end and a place on the triangle, or a place on the segment and one on an edge.
Real segment_distance2(const Vec3 (&t)[3], Real half) PALPATE_RT {
  const Vec3 up{0, 0, half};
  Real nearest = min_of(squared_norm(up - closest_on_triangle(up, t[0], t[1], t[2]).point),
                        squared_norm(-up - closest_on_triangle(-up, t[0], t[1], t[2]).point));
  Real turn[3];                  // about z, from corner to corner
  for (int k = 0; k < 3; ++k) {  // bound: 3
    const Vec3 a = t[k], d = t[k == 2 ? 0 : k + 1] - a;
    turn[k] = a.x * d.y - a.y * d.x;
    const Real square = d.x * d.x + d.y * d.y;
    const Vec3 q = a + (square > 0 ? clamp_to(-(a.x * d.x + a.y * d.y) / square, 0, 1) : 0.0) * d;
    if (abs_of(q.z) <= half) nearest = min_of(nearest, q.x * q.x + q.y * q.y);
  }
  const bool around = (turn[0] >= 0 && turn[1] >= 0 && turn[2] >= 0) || (turn[0] <= 0 && turn[1] <= 0 && turn[2] <= 0);
  const Real sum = turn[0] + turn[1] + turn[2];
  if (!around || sum == 0) return nearest;
  const Real height = (turn[1] * t[0].z + turn[2] * t[1].z + turn[0] * t[2].z) / sum;
  return abs_of(height) <= half ? 0.0 : nearest;
}

}  // namespace

OverlapResult overlap_piece_triangle(const Model& model, const ToolPiece& piece, const Pose& tool_w,
                                     const Vec3 (&triangle_w)[3], std::int32_t support_budget) PALPATE_RT {
  OverlapResult result;
  Pair pair{&piece, hull_of(model, piece), {}, 0, support_budget};
  const Pose piece_w = tool_w * piece.pose_tool;
  for (int k = 0; k < 3; ++k) {  // bound: 3
    pair.triangle_mm[k] = kMillimetresPerMetre * inverse_transform(piece_w, triangle_w[k]);
    if (!is_finite(pair.triangle_mm[k])) return result;
  }
  if (piece.shape == PieceShape::kSphere || piece.shape == PieceShape::kCapsule) {
    const Real half = piece.shape == PieceShape::kCapsule ? piece.half_extent_m[2] : 0.0;
    const Real margin_mm = kMillimetresPerMetre * piece.margin_m;
    const bool near = segment_distance2(pair.triangle_mm, kMillimetresPerMetre * half) <= margin_mm * margin_mm;
    return {near ? Overlap::kHit : Overlap::kMiss, kClosedFormSupports};
  }
  const bool hit = intersect(pair) != 0;
  result.support_calls = pair.calls;
  // A search that used every iteration answers "no" without having decided; it shows by its number of calls.
  const bool exhausted = pair.calls > support_budget || (!hit && pair.calls >= 2 * (1 + kGjkMaxIterations));
  result.overlap = exhausted ? Overlap::kInconclusive : hit ? Overlap::kHit : Overlap::kMiss;
  return result;
}

}  // namespace palpate
