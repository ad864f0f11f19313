// What a body's sharp edges take from the places near them under a tool of balls, for the bake of its numbers.
#pragma once

#include <vector>

#include "config/bake/facet_foot.h"
#include "config/bake/image_writer.h"
#include "config/bake/sharp_edges.h"
#include "config/elastic/edge_law.h"
#include "config/elastic/surface.h"

namespace palpate {

// The sharp edges that are not held: `fixed`, of every node's components, and `feet` of the surface's vertices tell.
SharpEdges free_sharp_edges(const ImageContents& image, const std::vector<CornerNormals>& normals,
                            const std::vector<FacetFoot>& feet, const std::vector<bool>& fixed);

// How near to an edge the patches of samples go over it, so that elements do not tell what it does: 1.5 of their edges.
double reach_of_edges_m(const elastic::Surface<3>& surface);

// A face is narrow where it is no wider than two balls: both its edges tell at once.
inline constexpr double kNarrowRadii = 4;

class EdgeFits {
 public:
  // `edges` must outlive it.
  EdgeFits(const SharpEdges& edges, double reach_m, const elastic::BallLaw& largest_ball, double depth_max_m)
      : edges_(edges), reach_m_(reach_m), ball_(largest_ball), depth_max_m_(depth_max_m) {}
  elastic::EdgeFit of_vertex(Vec3 place_m, Vec3 outward, double modulus_Pa, double curvature_1pm) const;
  // Of what elements have told at a node: to be left out between the samples.
  elastic::EdgeFit of_sample(const elastic::Surface<3>& surface, int node, double modulus_Pa,
                             double curvature_1pm) const;
  double radius_m() const { return ball_.radius_m; }

 private:
  elastic::EdgeFit fit(const elastic::SharpEdge& edge, double modulus_Pa, double curvature_1pm,
                       elastic::EdgeForm form) const;
  const SharpEdges& edges_;
  double reach_m_;
  elastic::BallLaw ball_;
  double depth_max_m_;
};

// The curvature that has a place's law scaled: the tick knows no other way.
double scaled_curvature_1pm(double curvature_1pm, double scale, double radius_m);

}  // namespace palpate
