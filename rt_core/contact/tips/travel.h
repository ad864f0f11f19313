// From the depth of tool tips to their forces: the tips' own laws in series with the body's far field,
// travel = local(F) + c0 F + c1 F^2 (a god-object proxy on the moved surface), and with one another.
#pragma once

#include <span>

#include "rt_core/contact/tips/line_law.h"
#include "rt_core/contact/tips/tip_law.h"
#include "rt_core/limits.h"

namespace palpate {

// Above this a solve counts as not converged: a nanometre, 50 uN on the stiffest tip law here (50 kN/m).
inline constexpr Real kTravelTolerance_m = 1e-9;

enum class TipKind : std::uint8_t { kPower, kTable, kLine };

// One tip in contact: its law and how deep it is.
struct Tip {
  LocalLaw local;
  TableLaw table;
  TipKind kind = TipKind::kPower;
  Real depth_m = 0;                   // travel
  Real scale = 1;                     // of the power law: a curved body's place is softer or stiffer
  const PlaceTerms* place = nullptr;  // beside the scaled law, or the line's
  const LineLaw* line = nullptr;
  void become(const LineLaw& law) PALPATE_RT {
    line = &law;
    kind = TipKind::kLine;
  }
};

// What a place adds to a line's energy, by its force f and the terms of Tip::place: second f^2 / 2 + between f^(7/3) +
// third f^(8/3). A power of the depth would not do: as the tip leans it stands elsewhere, and the depth is that of
// there.
PlaceEnergies line_energies(const LineLaw& line, Real e_m) PALPATE_RT;
LawPoint tip_at(const Tip& tip, Real e_m) PALPATE_RT;
// The stored energy at an indentation.
Real tip_energy_J(const Tip& tip, Real e_m) PALPATE_RT;

// Far field of one region, w(F) = c0 F + c1 F^2. Beyond force_max_N it continues by its tangent, so that a law whose c1
// is negative stays stable however deep the press.
struct FarField {
  Real c0_m_per_N = 0, c1_m_per_N2 = 0, force_max_N = kHuge;
};
Real far_shift_m(const FarField& far, Real force_N) PALPATE_RT;
Real far_slope_m_per_N(const FarField& far, Real force_N) PALPATE_RT;
// Energy held by it, integral of F dw: c0 F^2/2 + 2 c1 F^3/3.
Real far_energy_J(const FarField& far, Real force_N) PALPATE_RT;

// The tips of one region and the far field under them.
struct TipRegion {
  const Tip* tip = nullptr;  // `count` of them
  std::int32_t count = 0;
  FarField far;
};

// Sum over a region's tips with every depth reduced by shift_m.
LawPoint region_at(const TipRegion& region, Real shift_m) PALPATE_RT;

struct TravelResult {
  Real shift_m = 0;
  Real residual_m = 0;
  std::int32_t evaluations = 0;  // of the region's laws
};
// One region alone: the shift w with w = c0 F + c1 F^2, F = F(depth - w). The function w - far(F(w)) rises wherever the
// whole stiffness is positive, which the baker sees to; Newton with bisection as guard. F -> 0 needs no care: the
// unknown is a depth, not a force. `start_m`: a first shift, any number. Bound: kSeriesIterations law evaluations.
TravelResult solve_travel(const TipRegion& region, Real start_m = 0) PALPATE_RT;

// How regions i != j lean on one another: W = sum_{i<j} c_ij F_i F_j + sum_{i != j} h_ij F_i^2 F_j / 2 beside the far
// fields. Row-major n x n; c symmetric; diagonals unused.
struct TipCoupling {
  const Real* c_m_per_N;
  const Real* h_m_per_N2;  // nullptr: none
};
// Energy of the coupling between regions, sum F_i dW/dF_i - W without the regions' own far fields.
Real coupling_energy_J(std::int32_t n, const TipCoupling& coupling, const Real* force) PALPATE_RT;

// What the region solver (contact/region_solve.h) asks of coupled tips: forces are the gradient of one potential, so no
// loop returns energy while c and h are constant.
struct TipLaws {
  static constexpr std::int32_t kIterations = kTipNewtonIterations;
  static constexpr Real kEnough_m = 1e-14;  // rounding of a centimetre
  static constexpr Real kTolerance_m = kTravelTolerance_m;

  const TipRegion* region;
  TipCoupling coupling;
  std::int32_t n;
  std::int32_t* evaluated = nullptr;  // counts laws evaluated by start(), when given

  Real start(std::int32_t r) const PALPATE_RT {
    const TravelResult alone = solve_travel(region[r]);
    if (evaluated != nullptr) *evaluated += alone.evaluations * region[r].count;
    return alone.shift_m;
  }
  LawPoint load(std::int32_t r, Real shift_m) const PALPATE_RT { return region_at(region[r], shift_m); }
  Real shift_under(const Real* force, std::int32_t r) const PALPATE_RT;
  Real curvature(const Real* force, std::int32_t i, std::int32_t j) const PALPATE_RT;
};

}  // namespace palpate
