#include "config/response/corner_normals.h"

#include <algorithm>
#include <cmath>

#include "config/body/body_card.h"
#include "config/body/body_pose.h"
#include "config/index.h"
#include "rt_core/math.h"
#include "rt_core/surface/ring.h"

namespace palpate {

namespace {

Vec3 face_normal(const std::vector<Vec3>& vertex, const Triangle& t) {
  const Vec3 a = vertex[at(t.vertex[0])];
  return unit_or(cross(vertex[at(t.vertex[1])] - a, vertex[at(t.vertex[2])] - a), {0, 1, 0});
}

// What a triangle's normal counts at its corner k: the sine of the angle over the lengths of the sides (Max 1999),
// exact where the vertices lie on a sphere. By angles alone uneven triangles of a sphere, an ellipsoid and a torus are
// 2 to 4 times as far off, and on the dome of half_shell as a mesh of its own a rod that stood on the pole turned to
// and fro by 39 mN in 2,782 ticks, with these by 9 in 24 (2026-11-26). What fits a quadric to two rings is better by a
// third on uneven triangles, but not on even ones, and not on the heart's cleft, which its mesh does not resolve.
double corner_weight(const std::vector<Vec3>& vertex, const Triangle& t, int k) {
  const Vec3 p = vertex[at(t.vertex[k])];
  const Vec3 u = vertex[at(t.vertex[(k + 1) % 3])] - p, v = vertex[at(t.vertex[(k + 2) % 3])] - p;
  const double squares = squared_norm(u) * squared_norm(v);
  return squares > 0 ? norm(cross(u, v)) / squares : 0;
}

// Of a body where its shape is made.
std::vector<CornerNormals> own_normals(const BodyDesc& body, const std::vector<Vec3>& vertex_m,
                                       const std::vector<Triangle>& triangle) {
  std::vector<Vec3> face(triangle.size());
  for (std::size_t t = 0; t < triangle.size(); ++t) face[t] = face_normal(vertex_m, triangle[t]);
  double top = 0;
  for (const Vec3& p : vertex_m) top = std::max(top, p.y);
  const double smooth = math::cos(kCrease_rad);
  const auto exact_normal = card_of(body.shape).normal;
  std::vector<CornerNormals> result(triangle.size());
  std::vector<std::int32_t> fan;
  for (std::size_t t = 0; t < triangle.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t vertex = triangle[t].vertex[k];
      const Vec3 exact = exact_normal == nullptr ? Vec3{} : exact_normal(body, vertex_m[at(vertex)], face[t], top);
      if (squared_norm(exact) > 0.5) {
        result[t].normal[k] = exact;
        continue;
      }
      // Faces reached around the vertex over edges that are not sharp, in order of index: the same sum, and so the same
      // bits, for every corner of the fan.
      fan.assign(1, static_cast<std::int32_t>(t));
      for (std::size_t next = 0; next < fan.size(); ++next) {
        const Triangle& here = triangle[at(fan[next])];
        for (int e = 0; e < 3; ++e) {
          const std::int32_t other = here.adjacent[e];
          if (other < 0 || (here.vertex[e] != vertex && here.vertex[(e + 1) % 3] != vertex)) continue;
          if (std::find(fan.begin(), fan.end(), other) != fan.end()) continue;
          if (dot(face[at(fan[next])], face[at(other)]) >= smooth) fan.push_back(other);
        }
      }
      std::sort(fan.begin(), fan.end());
      Vec3 sum;
      for (const std::int32_t f : fan)
        sum += corner_weight(vertex_m, triangle[at(f)], corner_at(triangle[at(f)], vertex)) * face[at(f)];
      result[t].normal[k] = unit_or(sum, face[t]);
    }
  }
  return result;
}

}  // namespace

std::vector<CornerNormals> corner_normals(const BodyDesc& body, const std::vector<Vec3>& vertex_m,
                                          const std::vector<Triangle>& triangle) {
  std::vector<Vec3> own_m = vertex_m;
  take_back(body, own_m);
  std::vector<CornerNormals> result = own_normals(body, own_m, triangle);
  if (!is_moved(body)) return result;
  const Quat turn = body_pose(body).orientation;
  for (CornerNormals& corner : result)
    for (Vec3& normal : corner.normal) normal = rotate(turn, normal);
  return result;
}

double largest_sag_m(const std::vector<CornerNormals>& normals, const std::vector<Vec3>& vertex_m,
                     const std::vector<Triangle>& triangle) {
  constexpr double kPlace[4][3] = {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}};
  double largest = 0;
  for (std::size_t t = 0; t < triangle.size(); ++t) {
    for (const auto& n : kPlace) {
      Vec3 x;
      for (int k = 0; k < 3; ++k) x += n[k] * vertex_m[at(triangle[t].vertex[k])];
      double sag = 0;
      for (int k = 0; k < 3; ++k)
        sag += 0.5 * n[k] * dot(vertex_m[at(triangle[t].vertex[k])] - x, normals[t].normal[k]);
      largest = std::max(largest, std::abs(sag));
    }
  }
  return largest;
}

}  // namespace palpate
