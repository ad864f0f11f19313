// Large-strain presses of a body at its top as one smooth law: travel = local(F) + (c0 + c1 F + c2 F^2) F.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "config/fem/series_fit.h"
#include "config/response/press_shape.h"
#include "config/response/tip_bake.h"
#include "rt_core/contact/tips/tip_law.h"

namespace palpate {

// A tip's law with the factor table it points into.
struct OwnedLaw {
  TipLaw tip{};
  std::vector<FactorKnot> factor;
  LocalLaw local() const { return {&tip, tip.first_factor < 0 ? nullptr : factor.data()}; }
};
OwnedLaw make_owned_law(const TipDesc& tip);

// What the body gives beyond the tip's own law: the series law's far field, c2 for how c1 itself changes. Beyond
// force_max_N by its tangent.
struct FarSeries {
  double c0_m_per_N = 0, c1_m_per_N2 = 0, c2_m_per_N3 = 0;
  double force_max_N = 0;
  double travel_m(double force_N) const;
  double slope_m_per_N(double force_N) const;
};

struct PressSeries {
  FarSeries far;
  std::vector<fem::LoadPoint> press;  // solved
  double misfit = 0;                  // largest difference in travel over the depth
  int elements = 0;                   // under the tool
};

// Least squares in travel over depth. At least three presses.
FarSeries fit_far_series(const LocalLaw& local, const std::vector<fem::LoadPoint>& press);

// Where the presses of a range are made, as shares of it. The first is as deep as the mesh needs: a contact of fewer
// than three elements may find no equilibrium; shallower, the fit's local law takes over.
std::vector<double> press_shares(fem::RigidShape tool);

// Elements under the tool of the meshes to try.
std::span<const int> press_elements(fem::RigidShape tool);

// Presses to depth_max_m and their fit, on the first mesh that finds all equilibria. Throws ConfigError, saying how far
// the last attempt came, when none does, or when the fit misses a press by more than 2 % of its depth.
PressSeries press_series(const fem::PressBody& body, const fem::RigidTool& tool, const LocalLaw& local,
                         double depth_max_m, std::span<const int> meshes);

}  // namespace palpate
