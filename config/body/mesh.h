// A closed triangle surface, its derived quantities and the checks that make it safe to bake.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/vec.h"

namespace palpate {

struct Triangle;

// Corners counter-clockwise seen from outside.
using Corners = std::array<std::int32_t, 3>;

struct SurfaceMesh {
  std::vector<Vec3> vertex_m;
  std::vector<Corners> triangle;
};

// Triangle across the edge (corner k, corner k+1) of each triangle; -1 where there is none. Edges shared by more than
// two triangles are paired arbitrarily: check_mesh refuses them.
std::vector<Corners> triangle_adjacency(const SurfaceMesh& mesh);
// The triangles as an image has them, each with those.
std::vector<Triangle> linked_triangles(const SurfaceMesh& mesh);

// Not normalised; its length is twice the triangle's area.
Vec3 triangle_cross(const SurfaceMesh& mesh, std::size_t triangle);

// Outward unit normals weighted by the corner angle (Thuermer & Wuethrich 1998): the pseudo-normal whose sign test is
// exact on closed surfaces (Baerentzen & Aanaes 2005).
std::vector<Vec3> vertex_normals(const SurfaceMesh& mesh);

// Volume by the divergence theorem; negative when the surface is inside out. m^3.
double signed_volume_m3(const SurfaceMesh& mesh);
double surface_area_m2(const SurfaceMesh& mesh);
// Centre of the enclosed volume; the centre of the bounding box when the volume vanishes.
Vec3 volume_centre_m(const SurfaceMesh& mesh);

struct Bounds {
  Vec3 lower_m, upper_m;
  Vec3 size_m() const { return upper_m - lower_m; }
  Vec3 middle_m() const { return 0.5 * (lower_m + upper_m); }
  double largest_m() const;
};
Bounds bounds_of(std::span<const Vec3> point_m);  // all zero without a point
Bounds bounds_of(const SurfaceMesh& mesh);

// Number of edge-connected components.
std::int32_t component_count(const SurfaceMesh& mesh);

// Smallest and largest extent a body may have, metres: outside it the unit of the file is taken to be wrong.
inline constexpr double kSmallestBody_m = 1e-3;
inline constexpr double kLargestBody_m = 10.0;

// Turns triangles so that neighbours agree and the volume is positive. Leaves open and non-manifold edges alone.
void orient_mesh(SurfaceMesh& mesh);

// Throws ConfigError, naming `label` and the offending element, unless the mesh is one closed, outward-oriented,
// manifold surface of finite, non-degenerate triangles between 1 mm and 10 m in size. More than one component is
// refused: beams of the skeleton connect points of a single solid, and an inner shell would be a hole in it.
void check_mesh(const SurfaceMesh& mesh, const std::string& label);

}  // namespace palpate
