#include "config/bake/nodal_body.h"

#include <algorithm>
#include <cmath>

#include "config/scene/config_error.h"

namespace palpate {

namespace {

std::vector<NodalVertex> nodal_vertices(const CondensedBody& body, const std::vector<Triangle>& triangle) {
  std::vector<NodalVertex> vertex(body.surface.vertex_m.size(), NodalVertex{0, 1, 0, {}, 1});
  for (std::size_t i = 0; i < vertex.size(); ++i) vertex[i].is_free = body.held[i] == 0 ? 1 : 0;
  for (std::size_t t = 0; t < triangle.size(); ++t) {
    const auto corner = [&](int k) { return static_cast<std::size_t>(triangle[t].vertex[k]); };
    const auto& x = body.surface.vertex_m;
    const double area = 0.5 * norm(cross(x[corner(1)] - x[corner(0)], x[corner(2)] - x[corner(0)]));
    for (int k = 0; k < 3; ++k) vertex[corner(k)].area_m2 += area / 3;
  }
  return vertex;
}

// Triangles around one vertex that meet at less than this angle belong to one side of it.
const double kCreaseCosine = std::cos(60.0 * 3.14159265358979323846 / 180.0);
// A bend wider than this many edges is smooth enough as it is: its bulge is below a fortieth of an edge.
constexpr double kFlat_edges = 5;

// The ball that fits the most sharply bent smooth side of the surface at one vertex.
class Rounding {
 public:
  Rounding(const std::vector<Vec3>& position, const std::vector<Triangle>& triangle)
      : position_(position), triangle_(triangle), around_(position.size()) {
    for (std::size_t t = 0; t < triangle.size(); ++t)
      for (const std::int32_t v : triangle[t].vertex) around_[static_cast<std::size_t>(v)].push_back(t);
  }

  void fit(std::size_t vertex, NodalVertex& out) const {
    std::vector<std::size_t> left = around_[vertex];
    while (!left.empty()) fit_side(vertex, take_side(left), out);
  }

 private:
  Vec3 at(std::int32_t v) const { return position_[static_cast<std::size_t>(v)]; }
  Vec3 normal(std::size_t t) const {
    const auto& v = triangle_[t].vertex;
    return unit_or(cross(at(v[1]) - at(v[0]), at(v[2]) - at(v[0])), {0, 0, 1});
  }

  // Removes from `left` the triangles joined to its first one without crossing a crease.
  std::vector<std::size_t> take_side(std::vector<std::size_t>& left) const {
    std::vector<std::size_t> side{left.front()};
    left.erase(left.begin());
    for (std::size_t i = 0; i < side.size(); ++i) {
      for (const std::int32_t next : triangle_[side[i]].adjacent) {
        const auto found = std::find(left.begin(), left.end(), static_cast<std::size_t>(next));
        if (found == left.end() || dot(normal(side[i]), normal(*found)) < kCreaseCosine) continue;
        side.push_back(*found);
        left.erase(found);
      }
    }
    return side;
  }

  void fit_side(std::size_t vertex, const std::vector<std::size_t>& side, NodalVertex& out) const {
    const Vec3 x = position_[vertex];
    Vec3 mean;
    for (const std::size_t t : side) {
      Vec3 edge[2];
      int edges = 0;
      for (const std::int32_t v : triangle_[t].vertex)
        if (static_cast<std::size_t>(v) != vertex && edges < 2) edge[edges++] = unit_or(at(v) - x, {});
      mean += std::acos(std::clamp(dot(edge[0], edge[1]), -1.0, 1.0)) * normal(t);
    }
    mean = unit_or(mean, {0, 0, 1});
    // Curvature of the circle through the vertex, tangent to the surface there, and a neighbour.
    double sharpest = 0, length = 0;
    const auto each_edge = [&](auto&& visit) {
      for (const std::size_t t : side)
        for (const std::int32_t v : triangle_[t].vertex)
          if (static_cast<std::size_t>(v) != vertex)
            visit(2 * dot(mean, x - at(v)) / squared_norm(x - at(v)), norm(x - at(v)));
    };
    each_edge([&](double curvature, double) { sharpest = std::max(sharpest, curvature); });
    each_edge([&](double curvature, double edge) {
      if (curvature > 0.5 * sharpest) length = std::max(length, edge);
    });
    if (!(sharpest * kFlat_edges * length > 1)) return;
    const double radius = 1 / sharpest;
    if (out.round_m > 0 && out.round_m <= radius) return;
    out.round_m = radius;
    out.round_normal = mean;
    const double half = std::min(0.5 * length / radius, 0.9);  // sine of the angle to half way to the neighbour
    out.round_cosine = std::sqrt(1 - half * half);
  }

  const std::vector<Vec3>& position_;
  const std::vector<Triangle>& triangle_;
  std::vector<std::vector<std::size_t>> around_;
};

}  // namespace

BvhBuild add_nodal_body(const CondensedBody& body, CompliancePrecision precision, const std::string& label,
                        ImageContents& image) {
  const std::size_t n = body.surface.vertex_m.size();
  if (n > static_cast<std::size_t>(kMaxNodalVertices))
    throw ConfigError(label + ": " + std::to_string(n) + " surface nodes; allowed up to " +
                      std::to_string(kMaxNodalVertices) + ": use a coarser mesh, or linear elements away from contact");
  image.vertex_m = body.surface.vertex_m;
  image.vertex_normal = body.normal;
  BvhBuild bvh = build_bvh(image.vertex_m, linked_triangles(body.surface));
  image.triangle = bvh.triangle;
  image.bvh = bvh.node;
  image.nodal_vertex = nodal_vertices(body, bvh.triangle);
  const Rounding rounding(image.vertex_m, bvh.triangle);
  for (std::size_t i = 0; i < n; ++i) rounding.fit(i, image.nodal_vertex[i]);
  image.compliance_f32.clear();
  image.compliance_f64.clear();
  if (precision == CompliancePrecision::kDouble) {
    image.compliance_f64 = body.compliance_mpN;
  } else {
    image.compliance_f32.reserve(body.compliance_mpN.size());
    for (const double c : body.compliance_mpN) image.compliance_f32.push_back(static_cast<float>(c));
  }
  image.params.surface_size_m = bounds_of(body.surface).largest_m();
  return bvh;
}

double mean_edge_m(const SurfaceMesh& mesh) {
  double sum = 0;
  for (const Corners& t : mesh.triangle)
    for (std::size_t k = 0; k < 3; ++k)
      sum +=
          norm(mesh.vertex_m[static_cast<std::size_t>(t[k])] - mesh.vertex_m[static_cast<std::size_t>(t[(k + 1) % 3])]);
  return sum / (3.0 * static_cast<double>(mesh.triangle.size()));
}

}  // namespace palpate
