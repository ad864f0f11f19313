// Spreads tool points over the cores of the tool's pieces: each a small sphere of the piece's margin that carries the
// contact of the surface nearest to it.
#pragma once

#include <vector>

#include "config/bake/tool_surface.h"
#include "config/scene/scene.h"

namespace palpate {

struct Tool {
  std::vector<ToolPiece> piece;
  std::vector<ToolPoint> point;     // weight is left 0: it depends on the contact law's reference area
  std::vector<Vec3> hull_vertex_m;  // piece frame
  std::vector<HullFace> hull_face;  // piece frame
  std::vector<double> gap_m;        // per piece: largest distance from its touching surface to the nearest sphere
};

// Even, symmetric where the piece is, the same on every machine. Areas sum to the touching surface. Deterministic
// counts: a sphere has one point; a box a lattice of its surface; cylinders and cones rings; a hull its corners.
// Throws ConfigError when a piece cannot be spread as asked.
Tool make_tool(const std::vector<PieceDesc>& pieces);

struct ImageContents;
void put_tool(Tool tool, ImageContents& image);
// Smallest distance between two tool points of one hand's; kHuge where there is one point alone.
double nearest_points_m(const ImageContents& image);

// Core points of one piece, piece frame.
std::vector<Vec3> core_points(const PieceCore& core, std::int32_t count);
// Largest distance from a sample to the union of spheres about `point`; samples are 1/168 of a side apart, so the true
// figure can be larger by about half of that.
double coverage_gap_m(const std::vector<SurfaceSample>& sample, const std::vector<Vec3>& point, double margin_m);
// Rotation by a rotation vector of any length.
Quat rotation_of(Vec3 rotation_rad);

}  // namespace palpate
