#include "config/hand/hand_surface.h"

#include <algorithm>
#include <cmath>

#include "config/hand/hand_mesh.h"
#include "config/hand/hand_model.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

constexpr double kDegree = kPi / 180;
// Of the part's radius. The mesh is nowhere on the palm's side bent more sharply than by 0.8 of it, so the spheres stay
// within the surface; a quarter leaves the surface's own shape to the points, and rounds what lies between them.
constexpr double kMargin = 0.25;
// Half the breadth of the strip that touches. At a third of the radius deep, squeeze_mm of the shipped grasps in most
// parts, a flat body meets the part up to 48 degrees from its middle line.
constexpr double kHalfStrip = 40 * kDegree;

std::int32_t columns_for(std::int32_t points) { return points < 9 ? 1 : points < 25 ? 3 : 5; }

// Where a ray from the part's axis at height z leaves the mesh, and the smooth outward normal there.
struct SurfaceHit {
  Vec3 position_m, normal;
};
class PartSurface {
 public:
  explicit PartSurface(const ToolPiece& piece) : mesh_(hand_piece_mesh(piece)), normal_(vertex_normals(mesh_)) {}

  // `angle` from the palm's direction, about the axis. Mirror images for opposite angles.
  SurfaceHit at(double z_m, double angle) const {
    SurfaceHit hit = first({0, 0, z_m}, {math::cos(std::abs(angle)), math::sin(std::abs(angle)), 0});
    const double side = angle < 0 ? -1 : angle > 0 ? 1 : 0;
    hit.position_m.y *= side;
    hit.normal.y *= side;
    hit.normal = unit_or(hit.normal, {1, 0, 0});
    return hit;
  }

 private:
  // The farthest crossing: rays along an edge meet both of its triangles.
  SurfaceHit first(Vec3 from, Vec3 along) const {
    SurfaceHit best;
    double farthest = -1;
    for (const Corners& corners : mesh_.triangle) {
      const auto a = static_cast<std::size_t>(corners[0]), b = static_cast<std::size_t>(corners[1]),
                 c = static_cast<std::size_t>(corners[2]);
      const Vec3 ab = mesh_.vertex_m[b] - mesh_.vertex_m[a], ac = mesh_.vertex_m[c] - mesh_.vertex_m[a];
      const Vec3 p = cross(along, ac), t = from - mesh_.vertex_m[a], q = cross(t, ab);
      const double volume = dot(ab, p);
      if (!(std::abs(volume) > 1e-18)) continue;
      const double u = dot(t, p) / volume, v = dot(along, q) / volume, way = dot(ac, q) / volume;
      constexpr double kSlack = 1e-9;  // so that no ray slips between two triangles
      if (u < -kSlack || v < -kSlack || u + v > 1 + kSlack || way <= farthest) continue;
      farthest = way;
      best = {from + way * along, (1 - u - v) * normal_[a] + u * normal_[b] + v * normal_[c]};
    }
    return best;
  }

  SurfaceMesh mesh_;
  std::vector<Vec3> normal_;
};

// Evenly from -1 to 1; one alone is in the middle.
double station(std::int32_t k, std::int32_t count) { return count < 2 ? 0.0 : 2.0 * k / (count - 1) - 1; }

double gap_of(const PartSurface& surface, double half_m, const std::vector<Vec3>& centre, double margin_m) {
  constexpr std::int32_t kSamples = 21;
  std::vector<SurfaceSample> sample;
  for (std::int32_t i = 0; i < kSamples; ++i)
    for (std::int32_t k = 0; k < kSamples; ++k)
      sample.push_back({surface.at(half_m * station(i, kSamples), kHalfStrip * station(k, kSamples)).position_m, 0});
  return coverage_gap_m(sample, centre, margin_m);
}

}  // namespace

std::int32_t surface_point_count(std::int32_t at_most) { return at_most - at_most % columns_for(at_most); }

void touch_with_mesh(Tool& tool) {
  for (std::size_t i = 0; i < tool.piece.size(); ++i) {
    const ToolPiece& piece = tool.piece[i];
    if (piece.part < 1 || piece.part > kHandParts) continue;
    const PartSurface surface(piece);
    const std::int32_t columns = columns_for(piece.point_count), rows = piece.point_count / columns;
    const double margin_m = kMargin * piece.margin_m, half_m = piece.half_extent_m[2];
    std::vector<Vec3> centre;
    for (std::int32_t k = 0; k < piece.point_count; ++k) {
      const SurfaceHit hit =
          surface.at(half_m * station(k / columns, rows), kHalfStrip * station(k % columns, columns));
      centre.push_back(hit.position_m - margin_m * hit.normal);
      ToolPoint& point = tool.point[static_cast<std::size_t>(piece.first_point + k)];
      point.position_tool_m = transform(piece.pose_tool, centre.back());
      point.margin_m = margin_m;
    }
    tool.gap_m[i] = gap_of(surface, half_m, centre, margin_m);
  }
}

}  // namespace palpate
