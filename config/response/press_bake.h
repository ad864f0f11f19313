// The far field of the series law from finite-element presses at bake time.
#pragma once

#include "config/response/tip_bake.h"
#include "config/scene/scene.h"

namespace palpate {

// c0 and c1 of the series law for one piece, from a large-strain press of the scene's body at its top by the piece's
// own shape. `tip` holds the local law, with c0 = c1 = 0. Bodies of revolution only: standing cylinders and boxes (as a
// round block, bottom bonded or slipping), spheres and ellipsoids. Throws ConfigError naming the key.
struct FarFieldFit {
  double c0_m_per_N = 0, c1_m_per_N2 = 0;
};
FarFieldFit fit_far_field(const SceneDesc& scene, std::size_t piece, const TipDesc& tip);

// What two pieces feel of one another through a level top, from large-strain presses of each alone at its middle.
// `apart_m`: between their tips. Throws ConfigError naming the pair's key.
struct PairFit {
  double c_m_per_N = 0, h_ab_m_per_N2 = 0, h_ba_m_per_N2 = 0;
};
PairFit fit_pair_far_field(const SceneDesc& scene, std::size_t pair, double apart_m, const std::vector<TipDesc>& tip);

}  // namespace palpate
