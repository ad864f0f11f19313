// Puts a condensed finite-element body into an image.
#pragma once

#include "config/bake/bvh_build.h"
#include "config/bake/image_writer.h"
#include "config/fem/condense.h"

namespace palpate {

enum class CompliancePrecision : std::int32_t { kSingle, kDouble };

// Surface, hierarchy, nodal vertices and compliance of `body`. Returns the hierarchy's figures. Throws ConfigError,
// naming `label`, when the body has more surface nodes than a tick may address.
BvhBuild add_nodal_body(const CondensedBody& body, CompliancePrecision precision, const std::string& label,
                        ImageContents& image);

// Mean length of the surface's edges.
double mean_edge_m(const SurfaceMesh& mesh);

}  // namespace palpate
