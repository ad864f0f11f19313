// Which facet of a part of the surface a tip apart from it is above.
#pragma once

#include <cstdint>

#include "rt_core/math.h"
#include "rt_core/model.h"

namespace palpate {

// Places spread over a part, from any of which a foot may come down: on a clip's arm, whose round end hides its outside
// from what lies below it, nearness alone leaves a foot on the inner edge of that end.
inline constexpr std::int32_t kPartSeeds = 4;
struct PartSeeds {
  std::int32_t triangle[kPartSeeds];
};

// The first is where the bake has the foot begin, each next one the farthest from those before. When a Scratch is made.
PartSeeds spread_over_part(const Model& model, std::int32_t begins_at) noexcept;

// The cosine by which a facet with that normal, of any length, looks along `out`.
inline Real looks_to(Vec3 out, Vec3 up) PALPATE_RT {
  constexpr Real kLeast_m6 = 1e-60;
  return dot(out, up) / square_root(max_of(squared_norm(out) * squared_norm(up), kLeast_m6));
}

struct PartPlace {
  std::int32_t triangle;
  bool is_there;        // no facet beside it is nearer; else the next tick goes on
  std::int32_t looked;  // facets looked at
};
// Facets that come_down() goes over, with what is beside and beyond each.
inline constexpr std::int32_t kMostDown = 6;
inline constexpr std::int32_t kMostPartLooks = 1 + kPartSeeds + 9 * kMostDown;
// Facets that come_down() looks at in a tick, after which no other part is looked for: a tube on its way into a clip
// makes it 109, once in 8,000 ticks 148, and one that is thrown 251 (2026-11-28).
inline constexpr std::int32_t kPartShare = 112;
// From `triangle` on over facets while they come nearer to a place on the body at rest, from those that look away from
// it to those that do not first; or from a seed that is nearer. Newton's steps may lead a foot to where a part is
// farthest. Bound: kMostDown facets.
PartPlace come_down(const Model& model, const PartSeeds& seeds, Vec3 place_m, std::int32_t triangle) PALPATE_RT;

}  // namespace palpate
