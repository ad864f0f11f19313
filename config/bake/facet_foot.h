// Where places of the scene's surface lie on the elements' facets.
#pragma once

#include <span>
#include <vector>

#include "config/elastic/surface.h"
#include "rt_core/vec.h"

namespace palpate {

struct FacetFoot {
  std::vector<int> node;
  elastic::FacetShape shape;
};
std::vector<FacetFoot> facet_feet(const elastic::Surface<3>& surface, std::span<const Vec3> places);

}  // namespace palpate
