#include "config/bake/edge_fits.h"

#include <algorithm>

#include "config/elastic/self_terms.h"
#include "config/index.h"

namespace palpate {

namespace {

constexpr double kReach = 1.5;
// A vertex on an edge stands for the places about it that the mesh has no other for: with the edge's own numbers at its
// vertices a ball was 17 % too soft a sixth to a third of its radius beside it, with those at this share of the mesh's
// edge from it 5, and on the edge 25 too stiff instead of 15 (2026-11-28).
constexpr double kOfMesh = 0.25;

}  // namespace

SharpEdges free_sharp_edges(const ImageContents& image, const std::vector<CornerNormals>& normals,
                            const std::vector<FacetFoot>& feet, const std::vector<bool>& fixed) {
  std::vector<bool> held;
  for (const FacetFoot& foot : feet)
    held.push_back(std::ranges::any_of(
        foot.node, [&](int n) { return fixed[at(3 * n)] || fixed[at(3 * n + 1)] || fixed[at(3 * n + 2)]; }));
  return {image.vertex_m, normals, image.triangle, held};
}

double reach_of_edges_m(const elastic::Surface<3>& surface) {
  double sum = 0, count = 0;
  for (const elastic::Surface<3>::Facet& facet : surface.facets()) {
    sum += surface.edge_m(facet.nodes.front());
    count += 1;
  }
  return count > 0 ? kReach * sum / count : 0;
}

elastic::EdgeFit EdgeFits::fit(const elastic::SharpEdge& edge, double modulus_Pa, double curvature_1pm,
                               elastic::EdgeForm form) const {
  elastic::BallLaw ball = ball_;
  ball.modulus_Pa = modulus_Pa;
  ball.body_curvature_1pm = curvature_1pm;
  return elastic::fit_edge(edge, reach_m_, ball, depth_max_m_, form);
}

// Nothing at corners: there it threw a tip 3 mm deep to and fro between the edges, by 0.16 N of 20 (2026-11-28).
elastic::EdgeFit EdgeFits::of_vertex(Vec3 place_m, Vec3 outward, double modulus_Pa, double curvature_1pm) const {
  std::optional<elastic::SharpEdge> edge = edges_.about(place_m, outward, reach_m_, kNarrowRadii * ball_.radius_m);
  if (!edge || edge->is_corner || !(ball_.radius_m > 0)) return {};
  edge->distance_m = std::max(edge->distance_m, kOfMesh * edge->length_m);
  return fit(*edge, modulus_Pa, curvature_1pm, elastic::EdgeForm::kScaled);
}

elastic::EdgeFit EdgeFits::of_sample(const elastic::Surface<3>& surface, int node, double modulus_Pa,
                                     double curvature_1pm) const {
  const Vec3 place = elastic::vec(surface.rest(node)), outward = elastic::vec(elastic::node_normal(surface, node));
  const std::optional<elastic::SharpEdge> edge = edges_.about(place, outward, reach_m_, kNarrowRadii * ball_.radius_m);
  if (!edge || !(ball_.radius_m > 0)) return {};
  return fit(*edge, modulus_Pa, curvature_1pm, elastic::EdgeForm::kGiveAlone);
}

double scaled_curvature_1pm(double curvature_1pm, double scale, double radius_m) {
  return scale < 1 ? ((1 + curvature_1pm * radius_m) / (scale * scale) - 1) / radius_m : curvature_1pm;
}

}  // namespace palpate
