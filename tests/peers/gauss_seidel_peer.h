// Signorini's problem on a finite-element body as it is usually written down: dense compliance between the nodes near
// the tool, projected Gauss-Seidel (Jourdan, Alart & Jean 1998) in double precision with Eigen, warm from the last
// tick. Without friction and without carrying the geometry along, both of which our tick does.
#pragma once

#include <span>
#include <vector>

#include "rt_core/model.h"

namespace palpate::peers {

class GaussSeidelPeer {
 public:
  explicit GaussSeidelPeer(const Model& model);
  // Force on the body by the pieces where they stand.
  Vec3 force_N(std::span<const Pose> piece_w);
  int sweeps() const { return sweeps_; }  // of the last call
  int candidates() const { return candidates_; }

 private:
  double compliance(std::size_t row, std::size_t column) const;

  const Model& model_;
  std::vector<double> last_N_;  // of every node: where the next tick starts
  int sweeps_ = 0, candidates_ = 0;
};

}  // namespace palpate::peers
