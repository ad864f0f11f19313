#include "config/bake/sample_nodes.h"

#include <algorithm>

#include "config/elastic/self_terms.h"
#include "config/elastic/solid_mesh.h"
#include "config/index.h"

namespace palpate {

namespace {

// Elements' edges: on it.
constexpr double kOnEdge = 0.3;
// So far from others a node beside an edge is better than none: what its patches meet goes with its own distance. With
// those 2.5 mm beside an edge among others 5 mm apart a ball near a corner was 10 % too soft, without 6 (2026-11-28).
constexpr double kAlone = 2.5;

class Chosen {
 public:
  Chosen(const elastic::Surface<3>& surface, double spacing_m) : surface_(surface), spacing_m_(spacing_m) {}
  void offer(int node, double apart_m) {
    const double apart = std::max({spacing_m_, surface_.edge_m(node), apart_m});
    const Vec3 place = elastic::vec(surface_.rest(node)), normal = elastic::vec(elastic::node_normal(surface_, node));
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      if (norm(place_m_[k] - place) < apart && dot(outward_[k], normal) >= kFacing) return;
    nodes_.push_back(node);
    place_m_.push_back(place);
    outward_.push_back(normal);
  }
  const std::vector<int>& nodes() const { return nodes_; }

 private:
  const elastic::Surface<3>& surface_;
  double spacing_m_;
  std::vector<int> nodes_;
  std::vector<Vec3> place_m_, outward_;
};

}  // namespace

std::vector<int> sample_nodes(const elastic::Surface<3>& surface, const std::vector<bool>& fixed, double spacing_m,
                              const SharpEdges& edges, double reach_m, double narrow_m) {
  Chosen chosen(surface, spacing_m);
  std::vector<int> beside, on_edge;
  for (int n = 0; n < static_cast<int>(fixed.size() / 3); ++n) {
    if (surface.facets_at(n).empty() || fixed[at(3 * n)] || fixed[at(3 * n + 1)] || fixed[at(3 * n + 2)]) continue;
    const std::optional<elastic::SharpEdge> edge =
        edges.about(elastic::vec(surface.rest(n)), elastic::vec(elastic::node_normal(surface, n)), reach_m, narrow_m);
    if (!edge)
      chosen.offer(n, 0);
    else
      (edge->distance_m > kOnEdge * surface.edge_m(n) ? beside : on_edge).push_back(n);
  }
  for (const int n : beside) chosen.offer(n, kAlone * reach_m);
  for (const int n : on_edge) chosen.offer(n, kAlone * reach_m);
  return chosen.nodes();
}

}  // namespace palpate
