// Does a rounded tool piece touch a surface triangle? A yes/no cross-check; forces never come from here. Spheres and
// capsules by their distance, 900 instructions; the others by libccd, 13,000 where a capsule's end left a facet
// (2026-11-26).
#pragma once

#include <cstdint>

#include "rt_core/model.h"

namespace palpate {

enum class Overlap : std::int32_t { kMiss = 0, kHit = 1, kInconclusive = 2 };

struct OverlapResult {
  Overlap overlap = Overlap::kInconclusive;
  std::int32_t support_calls = 0;  // at most budget + kMostSupportsBeyond
};

// What a test asks for at least, and beyond its budget at most.
inline constexpr std::int32_t kLeastSupports = 2, kMostSupportsBeyond = 2;

// Tests the piece (core and margin, placed by tool_w) against a rest-surface triangle. kInconclusive when the support
// budget or the iteration limit ran out, or a coordinate is not finite: the caller keeps its last contact then.
// Allocation-free and bounded by `support_budget`, which is at least kLeastSupports.
OverlapResult overlap_piece_triangle(const Model& model, const ToolPiece& piece, const Pose& tool_w,
                                     const Vec3 (&triangle_w)[3],
                                     std::int32_t support_budget = kGjkSupportBudget) PALPATE_RT;

}  // namespace palpate
