#include "rt_core/contact/points/coupled_points.h"

namespace palpate {

namespace {
constexpr Double4 kLane{0, 1, 2, 3};
// From farther away each region alone is as good a start.
constexpr Real kGoesOn_m = 5e-6;
// Of the residual, a micronewton. From the last tick's forces one step is enough: in the scripted grasps they begin
// with at most 1.1 um and leave 8e-12 m at most, 1e-13 in half of 20,000 solves (2026-11-26).
constexpr Real kEnoughFromLast_m = 1e-11;
}  // namespace

CoupledPoints::CoupledPoints(const PointLaws& laws, const Real* compliance_m_per_N) PALPATE_RT
    : law_(laws.law),
      rows_(laws.region),
      compliance_(compliance_m_per_N),
      n_(laws.n),
      fours_(whole_lanes(laws.n, 4) / 4) {
  std::int32_t at = 0;
  for (std::int32_t i = 0; i < fours_; ++i) {  // bound: rows, and as many that are none
    std::int32_t most = 0;
    const std::int32_t regions = n_ - 4 * i < 4 ? n_ - 4 * i : 4;
    for (std::int32_t l = 0; l < regions; ++l)
      most = laws.region[4 * i + l].count > most ? laws.region[4 * i + l].count : most;
    first_[i] = at;
    for (std::int32_t k = 0; k < most; ++k) {
      depth_[at + k] = splat4(-kHuge);
      weight_[at + k] = Double4{};
      place_[at + k] = normal_[at + k] = Vec3x4{};
    }
    for (std::int32_t l = 0; l < regions; ++l) {
      const RegionRows& rows = laws.region[4 * i + l];
      for (std::int32_t k = 0; k < rows.count; ++k) {
        const Contact& contact = rows[k];
        depth_[at + k][l] = contact.depth_m;
        weight_[at + k][l] = contact.weight;
        place_[at + k].set(static_cast<std::uint32_t>(l), contact.position_w);
        normal_[at + k].set(static_cast<std::uint32_t>(l), contact.normal_w);
      }
    }
    at += most;
  }
  first_[fours_] = at;
  geometric_ = laws.region[0].geometric;
}

void CoupledPoints::start(Real* shift_m) const PALPATE_RT {
  for (std::int32_t i = 0; i < fours_; ++i) {  // bound: rows
    Double4 force{}, moment{}, tangent{};
    for (std::int32_t k = first_[i]; k < first_[i + 1]; ++k) {
      const LawPoint4 load = law_at(law_, depth_[k]);
      const Double4 pressed = weight_[k] * load.force_N;
      force += pressed;
      moment += pressed * depth_[k];
      tangent += weight_[k] * load.tangent_N_per_m;
    }
    Double4 own{};
    for (std::int32_t r = 4 * i; r < n_ && r < 4 * i + 4; ++r) own[r - 4 * i] = compliance_[r * (kRegionStride + 1)];
    const Double4 softening = own * tangent;
    const Double4 shift = moment / force * (softening / (splat4(1.0) + softening));
    store(shift_m + 4 * i, force > Double4{} ? shift : Double4{});
  }
}

// C times one number of each region, of four regions.
Double4 CoupledPoints::moved_by(const Real* per_region, std::int32_t four) const PALPATE_RT {
  Double4 sum{};
  const Real* row = compliance_ + 4 * four;
  for (std::int32_t j = 0; j < n_; ++j, row += kRegionStride) sum += load4(row) * splat4(per_region[j]);  // regions
  return sum;
}

RegionSolution CoupledPoints::solve(const Real* before_N, RegionSystem& s) const PALPATE_RT {
  RegionSolution result;
  bool usable = true;                          // forces of a state spoilt in memory are not
  for (std::int32_t i = 0; i < fours_; ++i) {  // bound: regions^2
    const Double4 shift = moved_by(before_N, i);
    usable &= bits_of(abs_of(shift) <= splat4(kHuge)) == 15;
    store(s.shift_m + 4 * i, shift);
  }
  result.residual_m = usable ? evaluate(s.shift_m, s) : kHuge;
  result.evaluations = usable ? 1 : 0;
  if (!(result.residual_m <= kGoesOn_m)) {
    start(s.shift_m);
    result.residual_m = evaluate(s.shift_m, s);
    result.evaluations += 1;
  }
  refine_regions(*this, n_, s, kEnough_m, result, false, kEnoughFromLast_m);
  return result;
}

Real CoupledPoints::evaluate(const Real* shift_m, RegionSystem& s) const PALPATE_RT {
  for (std::int32_t i = 0; i < fours_; ++i) {  // bound: rows
    const Double4 shift = load4(shift_m + 4 * i);
    Double4 force{}, tangent{};
    for (std::int32_t k = first_[i]; k < first_[i + 1]; ++k) {
      const LawPoint4 load = law_at(law_, depth_[k] - shift);
      force += weight_[k] * load.force_N;
      tangent += weight_[k] * load.tangent_N_per_m;
    }
    store(s.force_N + 4 * i, force);
    store(s.root_tangent + 4 * i, square_root(tangent));
  }
  for (std::int32_t i = 0; i < fours_; ++i)  // bound: regions^2
    store(s.residual_m + 4 * i, moved_by(s.force_N, i) - load4(shift_m + 4 * i));
  Real largest = 0;
  for (std::int32_t r = 0; r < n_; ++r) largest = max_of(abs_of(s.residual_m[r]), largest);  // bound: regions
  return largest;
}

// Row j of I + g C g from its diagonal's four on, kWide of them, less what U's rows above take from it.
template <int kWide>
void CoupledPoints::reduce_row(RegionSystem& s, std::int32_t j) const PALPATE_RT {
  const std::int32_t begin = 4 * (j / 4);
  const Real* const g = s.root_tangent;
  Double4 left[static_cast<std::size_t>(kWide)];
#pragma GCC unroll 4
  for (int i = 0; i < kWide; ++i)
    left[i] = load4(g + begin + 4 * i) * load4(compliance_ + j * kRegionStride + begin + 4 * i) * splat4(g[j]);
  left[0] += splat4(j - begin) == kLane ? splat4(1.0) : Double4{};
  const Real* above = s.factor + begin;
  for (std::int32_t k = 0; k < j; ++k, above += kRegionStride) {  // bound: regions
    const Double4 share = splat4(above[j - begin]);
#pragma GCC unroll 4
    for (int i = 0; i < kWide; ++i) left[i] -= load4(above + 4 * i) * share;
  }
#pragma GCC unroll 4
  for (int i = 0; i < kWide; ++i) store(s.factor + j * kRegionStride + begin + 4 * i, left[i]);
}

// I + g C g = U^T U as in cholesky.h, by U's rows: what is left of one stays in registers. The diagonal is in `pivot`
// and 0 in U, like what is below it, so that whole lanes may be taken of a row. Bound: regions^3 / 6 multiply-adds.
bool CoupledPoints::factorise(RegionSystem& s, Real* pivot) const PALPATE_RT {
  static_assert(kFours == 4);
  for (std::int32_t j = 0; j < n_; ++j) {
    const std::int32_t begin = j / 4;
    switch (fours_ - begin) {
      case 1:
        reduce_row<1>(s, j);
        break;
      case 2:
        reduce_row<2>(s, j);
        break;
      case 3:
        reduce_row<3>(s, j);
        break;
      default:
        reduce_row<4>(s, j);
        break;
    }
    Real* const row = s.factor + j * kRegionStride;
    const Real g = s.root_tangent[j], scale = g * compliance_[j * (kRegionStride + 1)] * g + 1.0;
    if (!(row[j] > 1e-14 * scale && row[j] < kHuge * kHuge)) return false;
    pivot[j] = square_root(row[j]);
    const Double4 inverse = splat4(1.0 / pivot[j]);
    for (std::int32_t i = begin; i < fours_; ++i) store(row + 4 * i, load4(row + 4 * i) * inverse);
    store(row + 4 * begin, kLane > splat4(j - 4 * begin) ? load4(row + 4 * begin) : Double4{});
  }
  return true;
}

bool CoupledPoints::newton_step(RegionSystem& s) const PALPATE_RT {
  Real pivot[kMaxRegions];
  if (!factorise(s, pivot)) return false;
  Real* y = s.trial_m;
  for (std::int32_t i = 0; i < fours_; ++i)  // bound: regions
    store(y + 4 * i, -load4(s.root_tangent + 4 * i) * load4(s.residual_m + 4 * i));
  for (std::int32_t k = 0; k < n_; ++k) {  // bound: regions^2 / 2
    y[k] /= pivot[k];
    for (std::int32_t i = k / 4; i < fours_; ++i)
      store(y + 4 * i, load4(y + 4 * i) - load4(s.factor + k * kRegionStride + 4 * i) * splat4(y[k]));
  }
  for (std::int32_t i = n_ - 1; i >= 0; --i) {  // bound: regions^2 / 2
    const Real* row = s.factor + i * kRegionStride;
    Real left = y[i];
#pragma GCC unroll 4
    for (std::int32_t k = i + 1; k < n_; ++k) left -= row[k] * y[k];
    y[i] = left / pivot[i];
  }
  for (std::int32_t i = 0; i < fours_; ++i) store(y + 4 * i, load4(y + 4 * i) * load4(s.root_tangent + 4 * i));
  for (std::int32_t i = 0; i < fours_; ++i)  // bound: regions^2
    store(s.step_m + 4 * i, load4(s.residual_m + 4 * i) + moved_by(y, i));
  return true;
}

}  // namespace palpate
