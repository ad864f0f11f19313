// How numbers at a mesh's vertices change along its surface.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "rt_core/model.h"

namespace palpate {

// Gradient along the surface at every vertex, in units of value per metre: what fits the differences to the neighbours
// best by least squares, with no part along the vertex's normal. Zero where the neighbours span no plane.
std::vector<Vec3> vertex_slopes(std::span<const Vec3> vertex_m, std::span<const Vec3> normal,
                                std::span<const Triangle> triangles, std::span<const double> value);

// Leaves of the gradients at a sharp edge what runs along it, and at corners nothing: beyond the edge a place holds
// still across it, so that cubics through values and gradients have no kink there.
void stop_at_sharp_edges(std::span<const Vec3> vertex_m, std::span<const CornerNormals> normal,
                         std::span<const Triangle> triangles, std::span<Vec3> slope);

// xx, xy, xz, yy, yz, zz.
using Bend = std::array<double, 6>;

// Second derivatives along the surface at every vertex: what fits best those that the cubics along its edges have
// there, through values and gradients at both ends.
std::vector<Bend> vertex_bends(std::span<const Vec3> vertex_m, std::span<const Triangle> triangles,
                               std::span<const double> value, std::span<const Vec3> slope);

// How fast the surface's normal turns at every vertex, convex positive: the second fundamental form that fits best the
// turns of the corners' normals along its edges.
std::vector<Bend> vertex_curvatures(std::span<const Vec3> vertex_m, std::span<const CornerNormals> normal,
                                    std::span<const Triangle> triangles);
// A surface's principal curvatures, the larger first: eigenvalues of that form, which has nothing along the normal.
std::array<double, 2> principal_curvatures(const Bend& form);

}  // namespace palpate
