// Tetrahedral meshes of simple bodies, made without a mesh generator: triangles in a plane, extruded along z into
// prisms of three tetrahedra. All elements are quadratic; boundary edges follow the exact circle. Lengths in metres.
#pragma once

#include <cstdint>
#include <vector>

#include "config/fem/material.h"
#include "config/fem/tet_mesh.h"

namespace palpate {

// Triangles counter-clockwise in the plane z = 0.
struct PlaneMesh {
  std::vector<Vec3> node_m;
  std::vector<Corners> triangle;
};

// Linear tetrahedra between the given heights (increasing). A prism's sides are cut from the lower-numbered node below
// to the higher-numbered one above, so neighbours always agree (Dompierre et al. 1999).
TetMesh extrude(const PlaneMesh& plane, const std::vector<double>& height_m);
std::vector<double> equal_steps(double from_m, double to_m, std::int32_t steps);

// Box centred at x = z = 0 standing on y = 0, `cells` boxes of six tetrahedra along x, y, z.
TetMesh make_box_tets(Vec3 size_m, std::array<std::int32_t, 3> cells);
// The same, but where the number of cells along x or z is even the mesh is its own mirror image there, element by
// element and to the last bit: tools that press it symmetrically feel the same forces.
TetMesh make_mirrored_box_tets(Vec3 size_m, std::array<std::int32_t, 3> cells);
// Ring around the z axis, symmetric about z = 0; `cells` around, across the wall, along z.
TetMesh make_ring_tets(double inner_m, double outer_m, double width_m, std::array<std::int32_t, 3> cells);

// A pipe clip like the one of Duriez, Andriot & Kheddar (2003, section 5): an open ring around the z axis, opening
// towards +y, symmetric about x = 0 and z = 0, with round arm tips.
struct ClipShape {
  double inner_m = 0.010, thickness_m = 0.002, width_m = 0.010;
  double half_opening_rad = 50.0 * 3.14159265358979323846 / 180.0;  // arms end this far from +y
  double half_foot_rad = 20.0 * 3.14159265358979323846 / 180.0;     // outer surface held this far from -y
};
inline constexpr std::int32_t kMostClipLevel = 3;
// Three meshes for a convergence study. Level 1: 717 nodes, 282 quadratic elements (the paper: 686 and 293).
// Throws ConfigError for another level.
TetMesh make_clip_mesh(std::int32_t level, const ClipShape& shape = {});
// Elements too flat to solve on, whose surface follows the clip's: facets of 2 degrees along the arms, 5 round their
// ends.
TetMesh make_clip_outline(const ClipShape& shape = {});
Supports clip_supports(const TetMesh& mesh, const ClipShape& shape = {});

}  // namespace palpate
