// Normals of the smooth surface that a mesh approximates, per triangle corner.
#pragma once

#include <vector>

#include "config/scene/scene.h"
#include "rt_core/model.h"

namespace palpate {

// Edges with a turn sharper than this are sharp: normals are not shared across them.
inline constexpr double kCrease_rad = 20.0 * 3.14159265358979323846 / 180.0;

// Weighted mean (Max 1999) of the faces around each vertex that are connected without crossing a sharp edge; the exact
// normal where the body's shape has one (sphere, ellipsoid, side of a cylinder).
std::vector<CornerNormals> corner_normals(const BodyDesc& body, const std::vector<Vec3>& vertex_m,
                                          const std::vector<Triangle>& triangle);

// Largest distance by which the smooth surface stands off the facets, from the normals: (V_i - X) . U_i / 2 over
// facets' middles and edges' middles. Metres.
double largest_sag_m(const std::vector<CornerNormals>& normals, const std::vector<Vec3>& vertex_m,
                     const std::vector<Triangle>& triangle);

}  // namespace palpate
