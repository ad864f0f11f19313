// Anchor points of the beam skeleton: curvature-extremal points of the body (Luo & Xiao 2006, section V). "Extremal" is
// made precise as: critical points (maximum, minimum, saddle) of the Gaussian curvature on smooth parts, corners of
// feature edges, and a few points on closed feature loops. Local extrema alone would miss the middle axis of an
// ellipsoid, whose ends are saddles.
#pragma once

#include <vector>

#include "config/body/mesh.h"
#include "config/scene/scene.h"

namespace palpate {

struct AnchorPoint {
  Vec3 position_m;  // on the surface
  Vec3 normal;      // outward unit
  double rank = 0;  // importance: the largest are kept first
};

// True for all shapes but hearts and meshes.
bool has_exact_anchors(BodyShape shape);
// Exact points of those shapes, in the frame of config/body/procedural.h: 6 on ellipsoids and spheres, 8 on cylinders
// and boxes; on surfaces of revolution 4 on each circle of a profile corner, inflection or curvature extremum, and
// smooth poles; on half shells, rings and hollow cylinders the same for the outer and the inner surface.
std::vector<AnchorPoint> exact_anchors(const BodyDesc& body);

// From a closed mesh that passed check_mesh. Curvature by quadric fits in a radius of 0.3 of the smallest half extent,
// so that vertex noise far below that radius does not matter; then smoothing, topological persistence (10 % of the
// range), non-maximum suppression at 0.3 of the mean half extent, and coverage: no surface point farther from an anchor
// than kAnchorCoverage of the mean half extent. The six points of a 40 x 30 x 25 mm ellipsoid leave 0.95 of it, and
// noise moves flat extrema by millimetres (measured 2026-11-21): below 1.2, points appear that no extremum asks for.
inline constexpr double kAnchorCoverage = 1.2;
std::vector<AnchorPoint> mesh_anchors(const SurfaceMesh& mesh);

// Keeps the `most` highest-ranked and adds support points along the principal axes, then farthest points, until there
// are `fewest`. Used for exact anchors as well.
void limit_anchors(const SurfaceMesh& mesh, std::int32_t fewest, std::int32_t most, std::vector<AnchorPoint>& anchors);

// Half extents of the vertices along their principal axes, largest first, with the axes.
struct PrincipalExtents {
  Vec3 centre_m;
  Vec3 axis[3];
  double half_extent_m[3];
  double mean_m() const { return (half_extent_m[0] + half_extent_m[1] + half_extent_m[2]) / 3; }
};
PrincipalExtents principal_extents(const SurfaceMesh& mesh);

// Feature edges (dihedral above 35 degrees) joined into curves; used by mesh_anchors.
struct Features {
  std::vector<char> on_feature;      // per vertex
  std::vector<AnchorPoint> anchors;  // corners and loop points
};
Features find_features(const SurfaceMesh& mesh, const std::vector<Vec3>& normal, double mean_half_extent_m);

// Critical points of curvature on the smooth part; used by mesh_anchors.
std::vector<AnchorPoint> curvature_anchors(const SurfaceMesh& mesh, const std::vector<Vec3>& normal,
                                           const std::vector<char>& on_feature, const PrincipalExtents& extents);

}  // namespace palpate
