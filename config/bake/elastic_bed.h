// Elastic beds as springs between the nodes of the surface: int k N N dA (Winkler 1867).
#pragma once

#include <vector>

#include "config/body/supports.h"
#include "config/elastic/surface.h"
#include "config/fem/large_strain_solver.h"

namespace palpate {

// Under the facets all of whose nodes a bed has, in the order of their degrees of freedom.
std::vector<fem::NodeSpring> bed_springs(const elastic::Surface<3>& surface, const std::vector<ElasticBed>& beds);

}  // namespace palpate
