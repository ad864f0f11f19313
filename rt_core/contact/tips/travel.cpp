#include "rt_core/contact/tips/travel.h"

namespace palpate {

namespace {

// Lowest shift over depth: see solve_travel.
constexpr Real kMostSwelling = 20.0;

// A line that leans touches at its end before it does where it stands.
Real deepest_m(const TipRegion& region) PALPATE_RT {
  Real deepest = 0;
  for (std::int32_t k = 0; k < region.count; ++k) {  // bound: tips
    const Tip& tip = region.tip[k];
    const Real before = tip.kind == TipKind::kLine ? max_of(-tip.line->touches_at_m(), 0.0) : 0.0;
    deepest = max_of(tip.depth_m + before, deepest);
  }
  return deepest;
}

// Second-order entry of pair (i, j): 0 without h.
Real h_of(const TipCoupling& coupling, std::int32_t i, std::int32_t j, std::int32_t n) PALPATE_RT {
  return coupling.h_m_per_N2 == nullptr ? 0.0 : coupling.h_m_per_N2[i * n + j];
}

// Slopes of line_energies in the line's force; its stiffness' slope is that of a power of the depth.
LawPoint line_at(const Tip& tip, Real e_m) PALPATE_RT {
  const LineLaw::Point line = tip.line->near(e_m);
  const PlaceTerms& add = *tip.place;
  const Real f = line.force_N, k = line.tangent_N_per_m, root = line.root_force, depth = e_m - tip.line->touches_at_m();
  if (!(f > 0 && depth > 0)) return {};
  const Real a = root * add.between_N_per_m25, b = root * root * add.third_N_per_m3;
  const Real by = f * (add.second_N_per_m2 + 7.0 / 3 * a + 8.0 / 3 * b);
  const Real by2 = add.second_N_per_m2 + 28.0 / 9 * a + 40.0 / 9 * b;
  return {f + by * k, k * (1 + by2 * k + by * (k / f - 1.0 / depth))};
}

}  // namespace

PlaceEnergies line_energies(const LineLaw& line, Real e_m) PALPATE_RT {
  const LineLaw::Point at = line.near(e_m);
  const Real root = at.root_force, square = at.force_N * at.force_N;
  return {{0.5 * square, square * root, square * root * root, 0}};
}

LawPoint tip_at(const Tip& tip, Real e_m) PALPATE_RT {
  if (tip.kind != TipKind::kPower) return tip.kind == TipKind::kTable ? table_at(tip.table, e_m) : line_at(tip, e_m);
  const LawPoint point = local_at(tip.local, e_m);
  if (tip.place == nullptr) return {tip.scale * point.force_N, tip.scale * point.tangent_N_per_m};
  const LawPoint place = place_at(*tip.place, tip.local.tip->depth_max_m, e_m);
  return {tip.scale * point.force_N + place.force_N, tip.scale * point.tangent_N_per_m + place.tangent_N_per_m};
}

Real tip_energy_J(const Tip& tip, Real e_m) PALPATE_RT {
  if (tip.kind == TipKind::kLine) return tip.line->near(e_m).energy_J + line_energies(*tip.line, e_m).J(*tip.place);
  if (tip.kind != TipKind::kTable) {
    const Real energy = tip.scale * local_energy_J(tip.local, e_m);
    return tip.place == nullptr ? energy : energy + place_energy_J(*tip.place, tip.local.tip->depth_max_m, e_m);
  }
  const CornerEnergies corner = table_energies(tip.table, e_m);
  return tip.table.weight[0] * corner.energy_J[0] + tip.table.weight[1] * corner.energy_J[1] +
         tip.table.weight[2] * corner.energy_J[2];
}

Real far_shift_m(const FarField& far, Real force_N) PALPATE_RT {
  const Real inside = min_of(force_N, far.force_max_N);
  return far.c0_m_per_N * force_N + far.c1_m_per_N2 * (2.0 * force_N - inside) * inside;
}
Real far_slope_m_per_N(const FarField& far, Real force_N) PALPATE_RT {
  return far.c0_m_per_N + 2.0 * far.c1_m_per_N2 * min_of(force_N, far.force_max_N);
}
Real far_energy_J(const FarField& far, Real force_N) PALPATE_RT {
  const Real inside = min_of(force_N, far.force_max_N), square = inside * inside;
  const Real energy = (0.5 * far.c0_m_per_N + (2.0 / 3.0) * far.c1_m_per_N2 * inside) * square;
  return energy + 0.5 * far_slope_m_per_N(far, force_N) * (force_N * force_N - square);
}

LawPoint region_at(const TipRegion& region, Real shift_m) PALPATE_RT {
  LawPoint sum;
  for (std::int32_t k = 0; k < region.count; ++k) {  // bound: tips of the region
    const LawPoint point = tip_at(region.tip[k], region.tip[k].depth_m - shift_m);
    sum.force_N += point.force_N;
    sum.tangent_N_per_m += point.tangent_N_per_m;
  }
  return sum;
}

TravelResult solve_travel(const TipRegion& region, Real start_m) PALPATE_RT {
  if (region.far.c0_m_per_N == 0 && region.far.c1_m_per_N2 == 0) return {};
  const Real deepest = deepest_m(region);
  // At w = deepest every force is zero and the function is positive. Below zero it can only be where c0 or c1 is
  // negative; the baker leaves the whole law a twentieth of the tip's stiffness or more, so e = deepest - w stays below
  // twenty depths.
  Real low = -kMostSwelling * deepest, high = deepest;
  TravelResult result;
  if (start_m > low && start_m < high) result.shift_m = start_m;
  for (std::int32_t i = 0; i < kSeriesIterations; ++i) {  // bound: kSeriesIterations
    const LawPoint load = region_at(region, result.shift_m);
    const Real rest = result.shift_m - far_shift_m(region.far, load.force_N);
    result.residual_m = abs_of(rest);
    result.evaluations = i + 1;
    const Real slope = 1.0 + far_slope_m_per_N(region.far, load.force_N) * load.tangent_N_per_m;
    // Rounding of w comes back `slope` times over: where the body is much softer than the tip it never fell below.
    if (!(result.residual_m > 1e-15 * deepest * max_of(slope, 1.0))) break;
    (rest > 0 ? high : low) = result.shift_m;
    const Real newton = result.shift_m - rest / slope;
    result.shift_m = slope > 0 && newton > low && newton < high ? newton : 0.5 * (low + high);
    if (!(high - low > 1e-17)) break;
  }
  return result;
}

Real TipLaws::shift_under(const Real* force, std::int32_t i) const PALPATE_RT {
  Real shift = far_shift_m(region[i].far, force[i]);
  for (std::int32_t j = 0; j < n; ++j) {  // bound: regions
    if (j == i) continue;
    const Real h = h_of(coupling, i, j, n) * force[i] + 0.5 * h_of(coupling, j, i, n) * force[j];
    shift += (coupling.c_m_per_N[i * n + j] + h) * force[j];
  }
  return shift;
}

Real TipLaws::curvature(const Real* force, std::int32_t i, std::int32_t j) const PALPATE_RT {
  if (i != j) {
    return coupling.c_m_per_N[i * n + j] + h_of(coupling, i, j, n) * force[i] + h_of(coupling, j, i, n) * force[j];
  }
  Real sum = far_slope_m_per_N(region[i].far, force[i]);
  for (std::int32_t k = 0; k < n; ++k) {  // bound: regions
    if (k != i) sum += h_of(coupling, i, k, n) * force[k];
  }
  return sum;
}

Real coupling_energy_J(std::int32_t n, const TipCoupling& coupling, const Real* force) PALPATE_RT {
  Real energy = 0;
  for (std::int32_t i = 0; i < n; ++i) {  // bound: regions^2 / 2
    for (std::int32_t j = 0; j < i; ++j) {
      // W of degree two and three in F: F . dW/dF - W is W once and twice over.
      const Real first = coupling.c_m_per_N[i * n + j];
      const Real second = h_of(coupling, i, j, n) * force[i] + h_of(coupling, j, i, n) * force[j];
      energy += (first + second) * force[i] * force[j];
    }
  }
  return energy;
}

}  // namespace palpate
