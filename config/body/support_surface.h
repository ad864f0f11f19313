// Supports that are parts of a body's surface: patches about a place, triangles between listed vertices.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/fem/tet_mesh.h"
#include "config/scene/scene.h"

namespace palpate {

struct SurfacePlace {
  Vec3 place_m;
  std::size_t triangle = 0;
};
// The nearest place of the surface.
SurfacePlace nearest_on(const SurfaceMesh& surface, Vec3 p);

// Takes nodes out that are not of the surface.
void keep_surface(const TetSurface& skin, std::vector<char>& in);
// Takes nodes out that no edges between chosen nodes of the surface join to the place's triangle.
void keep_joined(const TetSurface& skin, const SurfacePlace& place, std::vector<char>& in);

// Whether a point near the body's surface is nearest to triangles between the entry's vertices. Throws ConfigError,
// naming `label`, for a file that cannot be read, numbers that the surface does not have, and lists without a triangle.
std::function<bool(Vec3)> on_listed_triangles(const SceneDesc& scene, const FixedDesc& entry, const std::string& label);

}  // namespace palpate
