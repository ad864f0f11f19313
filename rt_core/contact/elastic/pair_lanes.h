// What couples the regions of an elastic body, four regions at a time: of fifteen finger parts the pairs are 210
// numbers of three kinds, and one by one they took two thirds of the tick (2026-11-25). Arrays by region have room for
// kMaxRegions; lanes beyond the last region are zero in all of them.
#pragma once

#include "rt_core/lanes.h"
#include "rt_core/limits.h"

namespace palpate {

inline constexpr std::int32_t kRegionLanes = 4;
static_assert(kMaxRegions % kRegionLanes == 0);

// One by one: gcc makes a call to memset of a plain loop, for three numbers.
inline void end_lanes(std::int32_t n, Real* by_region) PALPATE_RT {
  const std::int32_t end = whole_lanes(n, kRegionLanes);
  if (n < end) by_region[n] = 0;
  if (n + 1 < end) by_region[n + 1] = 0;
  if (n + 2 < end) by_region[n + 2] = 0;
}

// W = sum_{i<j} c_ij F_i F_j + sum_{i != j} h_ij F_i^2 F_j / 2. Diagonals are zero.
struct PairLanes {
  Real c_m_per_N[kMaxRegions][kMaxRegions];
  Real h_m_per_N2[kMaxRegions][kMaxRegions];
  Real h_across_m_per_N2[kMaxRegions][kMaxRegions];  // transposed

  // C x + h' w and h x.
  void apply(std::int32_t n, const Real* x, const Real* w, Real* sum, Real* own) const PALPATE_RT {
    for (std::int32_t b = 0; b < n; b += kRegionLanes) {  // bound: kMaxRegions^2 / 4
      Double4 s{}, o{};
      for (std::int32_t j = 0; j < n; ++j) {
        s += splat4(x[j]) * load4(c_m_per_N[j] + b) + splat4(w[j]) * load4(h_m_per_N2[j] + b);
        o += splat4(x[j]) * load4(h_across_m_per_N2[j] + b);
      }
      store(sum + b, s);
      store(own + b, o);
    }
  }
  bool has_second_order(std::int32_t n) const PALPATE_RT {
    Double4 sum{};
    for (std::int32_t j = 0; j < n; ++j)  // bound: kMaxRegions^2 / 4
      for (std::int32_t b = 0; b < n; b += kRegionLanes) {
        const Double4 h = load4(h_m_per_N2[j] + b);
        sum += h * h;
      }
    return palpate::sum(sum) > 0;
  }
  void drop_second_order(std::int32_t n) PALPATE_RT {
    for (std::int32_t j = 0; j < n; ++j) {  // bound: kMaxRegions^2 / 4
      for (std::int32_t b = 0; b < n; b += kRegionLanes) {
        store(h_m_per_N2[j] + b, Double4{});
        store(h_across_m_per_N2[j] + b, Double4{});
      }
    }
  }
  // dW/dF, and d2W/dF2 on the diagonal.
  void slopes(std::int32_t n, const Real* force_N, Real* slope, Real* bend) const PALPATE_RT {
    Real half_square[kMaxRegions];
    for (std::int32_t b = 0; b < n; b += kRegionLanes)  // bound: kMaxRegions
      store(half_square + b, splat4(0.5) * load4(force_N + b) * load4(force_N + b));
    apply(n, force_N, half_square, slope, bend);
    for (std::int32_t b = 0; b < n; b += kRegionLanes)
      store(slope + b, load4(slope + b) + load4(force_N + b) * load4(bend + b));
  }
  // d2W/dF_j dF_i for the four i from b on, i != j.
  Double4 bends(const Real* force_N, std::int32_t j, std::int32_t b) const PALPATE_RT {
    return load4(c_m_per_N[j] + b) + splat4(force_N[j]) * load4(h_m_per_N2[j] + b) +
           load4(force_N + b) * load4(h_across_m_per_N2[j] + b);
  }
};

// Cholesky's factor by columns: what is below the diagonal, zeros above it, and the inverse of the diagonal.
struct FactorLanes {
  static constexpr Real kBelow[kRegionLanes][kRegionLanes] = {{0, 1, 1, 1}, {0, 0, 1, 1}, {0, 0, 0, 1}, {0, 0, 0, 0}};
  Real column[kMaxRegions][kMaxRegions];
  Real inverse[kMaxRegions];

  // Of what stands on and below the diagonal; false, with that spoiled, when a pivot is not clearly positive (or is
  // NaN). Bound: n^3 / 24 steps of four.
  bool factor(std::int32_t n) PALPATE_RT {
    for (std::int32_t j = 0; j < n; ++j) {
      const std::int32_t first = j / kRegionLanes * kRegionLanes;
      const Real scale = column[j][j];
      for (std::int32_t b = first; b < n; b += kRegionLanes) {
        Double4 left = load4(column[j] + b);
#pragma GCC unroll 4
        for (std::int32_t k = 0; k < j; ++k) left -= splat4(column[k][j]) * load4(column[k] + b);
        store(column[j] + b, left);
      }
      const Real pivot = column[j][j];
      if (!(pivot > 1e-14 * scale && pivot < kHuge * kHuge)) return false;
      inverse[j] = 1.0 / square_root(pivot);
      store(column[j] + first, load4(kBelow[j - first]) * splat4(inverse[j]) * load4(column[j] + first));
      for (std::int32_t b = first + kRegionLanes; b < n; b += kRegionLanes)
        store(column[j] + b, splat4(inverse[j]) * load4(column[j] + b));
    }
    return true;
  }
  // In place.
  void solve(std::int32_t n, Real* x) const PALPATE_RT {
    for (std::int32_t k = 0; k < n; ++k) {  // bound: n^2 / 8 steps of four
      const Real known = x[k] * inverse[k];
      for (std::int32_t b = k / kRegionLanes * kRegionLanes; b < n; b += kRegionLanes)
        store(x + b, load4(x + b) - splat4(known) * load4(column[k] + b));
      x[k] = known;
    }
    for (std::int32_t i = n - 1; i >= 0; --i) {
      Double4 rest{};
      for (std::int32_t b = i / kRegionLanes * kRegionLanes; b < n; b += kRegionLanes)
        rest += load4(column[i] + b) * load4(x + b);
      x[i] = (x[i] - sum(rest)) * inverse[i];
    }
  }
};

}  // namespace palpate
