// Closed surfaces made from a few numbers. Frame of all of them: x forward, y up, z right (right-handed); the lowest
// point lies on the plane y = 0 below the centre, so the world origin is the bottom centre, as in Luo & Xiao 2006
// (section VII). Lengths in metres.
#pragma once

#include <vector>

#include "config/body/mesh.h"
#include "rt_core/choice.h"

namespace palpate {

// Axis of revolution of bodies that may lie on their side.
#define PALPATE_BODY_AXES(X) X(kY, y) X(kX, x) X(kZ, z)
PALPATE_CHOICE(BodyAxis, PALPATE_BODY_AXES);

inline constexpr std::int32_t kFewestTriangles = 80;
inline constexpr std::int32_t kMostTriangles = 4'000'000;

// How a sphere is cut into triangles: geodesic, all of about one size: 20 f^2, the f nearest to the number asked for:
// 2880 for 3000, 30 420 for 30 000, 1 003 520 for a million. Rings, parallels and meridians every 180/n degrees with
// poles along y: 4 n (n - 1), the n nearest: 3480 for 3480, that of Cui & Xiao 2008, 1742 vertices, every 6 degrees.
#define PALPATE_SPHERE_PATTERNS(X) X(kGeodesic, geodesic) X(kRings, rings)
PALPATE_CHOICE(SpherePattern, PALPATE_SPHERE_PATTERNS);

// Half axes along x, y, z: a sphere scaled. Vertices lie on the exact surface.
SurfaceMesh make_ellipsoid(Vec3 half_axes_m, std::int32_t triangles, SpherePattern pattern = SpherePattern::kGeodesic);
SurfaceMesh make_box(Vec3 size_m, std::int32_t triangles);

// A point of a profile: distance from the y axis and height. A profile runs from bottom to top.
struct ProfilePoint {
  double radius_m, height_m;
};
// Turns sharper than this between profile segments are corners: kept sharp by the mesh, circles of anchors.
inline constexpr double kCornerAngle_rad = 35.0 * 3.14159265358979323846 / 180.0;
// The profile with its stretches between corners replaced by a centripetal Catmull-Rom curve sampled about every
// `spacing_m`; open ends are closed to the axis by discs. Heights are shifted so that the lowest is 0.
std::vector<ProfilePoint> refine_profile(const std::vector<ProfilePoint>& profile, double spacing_m);
// Indices of the corners of a profile (turns above kCornerAngle_rad), its two ends excepted.
std::vector<std::size_t> profile_corners(const std::vector<ProfilePoint>& profile);
// The closed surface swept by a profile around the y axis; the profile holds at least two points of positive length.
SurfaceMesh make_revolution(const std::vector<ProfilePoint>& profile, std::int32_t triangles);
SurfaceMesh make_cylinder(double radius_m, double height_m, std::int32_t triangles);

// Bodies with a hole, each one closed surface, outward normals. Exactly symmetric: mirror images of vertices and of
// triangles are in the mesh too, about x = 0 always, about the other middle planes where the number of cells around is
// a multiple of four. So a symmetric press gives symmetric beams.
// A dome open below: upper half of the ellipsoid less that of the one with half axes smaller by the wall, rim at y = 0.
SurfaceMesh make_half_shell(Vec3 half_axes_m, double wall_m, std::int32_t triangles);
// A torus of outer radius `radius_m` and a round section of diameter `wall_m`. Genus 1, as the next.
SurfaceMesh make_ring(double radius_m, double wall_m, BodyAxis axis, std::int32_t triangles);
SurfaceMesh make_hollow_cylinder(double radius_m, double wall_m, double height_m, BodyAxis axis,
                                 std::int32_t triangles);

// A heart: Taubin's surface (x^2 + 9/4 y^2 + z^2 - 1)^3 = x^2 z^3 + 9/80 y^2 z^3 (Taubin 1994) with its point and notch
// rounded, standing on its point with the two lobes up, its depth along z. `size_m` is its width along x.
SurfaceMesh make_heart(double size_m, std::int32_t triangles);

}  // namespace palpate
