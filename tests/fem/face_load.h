// Consistent nodal forces of a traction on faces of tetrahedra, straight or curved, by quadrature of the shape
// functions.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "config/fem/tet_element.h"

namespace palpate {

// Radon's seven points on a triangle, degree 5: barycentric coordinates and weight (sum 1).
struct FacePoint {
  double l[3], weight;
};
inline std::vector<FacePoint> face_rule() {
  std::vector<FacePoint> rule{{{1.0 / 3, 1.0 / 3, 1.0 / 3}, 0.225}};
  const double root = std::sqrt(15.0);
  for (const double s : {-1.0, 1.0}) {
    const double a = (6 + s * root) / 21, w = (155 + s * root) / 1200;
    for (int k = 0; k < 3; ++k) {
      FacePoint p{{a, a, a}, w};
      p.l[k] = 1 - 2 * a;
      rule.push_back(p);
    }
  }
  return rule;
}

// Adds `traction(position, outward unit normal)` (Pa) over every face whose corners all satisfy `on`.
inline std::vector<Vec3> face_load(const TetMesh& mesh, const std::function<bool(Vec3)>& on,
                                   const std::function<Vec3(Vec3, Vec3)>& traction) {
  std::vector<Vec3> force(mesh.node_m.size());
  const auto node = [&](std::int32_t i) { return mesh.node_m[static_cast<std::size_t>(i)]; };
  for (const Tet& tet : mesh.tet)
    for (std::size_t f = 0; f < 4; ++f) {
      bool all_on = true;
      for (const std::int32_t c : kTetFace[f]) all_on = all_on && on(node(tet.node[static_cast<std::size_t>(c)]));
      if (!all_on) continue;
      for (const FacePoint& p : face_rule()) {
        std::array<double, 4> lambda{};
        for (std::size_t k = 0; k < 3; ++k) lambda[static_cast<std::size_t>(kTetFace[f][k])] = p.l[k];
        const TetGradients slope = tet_shape_gradients(tet, lambda);
        const TetValues shape = tet_shape(tet, lambda);
        // Tangents along the two face sides: derivatives of lambda run along the parent axes; lambda 0 is the rest.
        Vec3 tangent[2], position;
        for (std::size_t k = 0; k < 10; ++k) {
          if (tet.node[k] < 0) continue;
          const auto row = static_cast<Eigen::Index>(k);
          position += shape(row) * node(tet.node[k]);
          const auto along = [&](std::int32_t corner) { return corner == 0 ? 0.0 : double{slope(row, corner - 1)}; };
          for (std::size_t s = 0; s < 2; ++s)
            tangent[s] += (along(kTetFace[f][s + 1]) - along(kTetFace[f][0])) * node(tet.node[k]);
        }
        const Vec3 cross_m2 = cross(tangent[0], tangent[1]);  // twice the area of the parent triangle's image
        const Vec3 t = traction(position, unit_or(cross_m2, {}));
        for (std::size_t k = 0; k < 10; ++k)
          if (tet.node[k] >= 0)
            force[static_cast<std::size_t>(tet.node[k])] +=
                (0.5 * p.weight * norm(cross_m2) * shape(static_cast<Eigen::Index>(k))) * t;
      }
    }
  return force;
}

}  // namespace palpate
