#include "rt_core/contact/nodes/strain.h"

#include <utility>

namespace palpate {

namespace {

constexpr std::int32_t kMostVectors = whole_lanes(6 * kMaxStrainGauges, 8) / 8;

// Strain components of all pushes, sizeof...(k) vectors of eight: what the registers hold. The last vector ends with
// the last component; what it shares with the one before comes out the same twice. Single precision, as the gauges are.
template <std::int32_t... k>
void add_strains(const float* gauges, const std::int32_t* row, const float* force, std::int32_t rows,
                 std::int32_t components, float* strain, std::integer_sequence<std::int32_t, k...>) PALPATE_RT {
  const std::int32_t end = components - 8;
  Float8 sum[] = {(static_cast<void>(k), Float8{})...};
  for (std::int32_t r = 0; r < rows; ++r) {  // bound: 3 kMaxContacts
    const Float8 f = splat8(force[r]);
    const float* from = gauges + row[r];
    ((sum[k] += load8(from + (k + 1 == sizeof...(k) ? end : 8 * k)) * f), ...);
  }
  (store(strain + (k + 1 == sizeof...(k) ? end : 8 * k), sum[k]), ...);
}

// Picks the number of vectors, from `most` down to 1.
template <std::int32_t most>
void add_strains(const float* gauges, const std::int32_t* row, const float* force, std::int32_t rows,
                 std::int32_t components, float* strain) PALPATE_RT {
  if constexpr (most > 1) {
    if (components <= 8 * (most - 1)) return add_strains<most - 1>(gauges, row, force, rows, components, strain);
  }
  add_strains(gauges, row, force, rows, components, strain, std::make_integer_sequence<std::int32_t, most>());
}

}  // namespace

Real largest_strain(const Model& model, const ContactProblem& p) PALPATE_RT {
  const auto components = static_cast<std::int32_t>(model.sizes.n_strain_gauge / (3 * model.sizes.n_vertex));
  std::int32_t row[3 * kMaxContacts];
  float force[3 * kMaxContacts];
  std::int32_t rows = 0;
  for (std::int32_t i = 0; i < p.count; ++i) {  // bound: kMaxContacts
    if (!(p.node[i].push.normal_N > 0)) continue;
    const Vec3 f = p.node[i].force_w;
    const Real by_axis[3] = {f.x, f.y, f.z};
    for (std::int32_t a = 0; a < 3; ++a, ++rows) {
      row[rows] = (3 * p.node[i].vertex + a) * components;
      force[rows] = static_cast<float>(by_axis[a]);
    }
  }
  alignas(32) float strain[6 * kMaxStrainGauges] = {};
  if (components >= 8) {
    add_strains<kMostVectors>(model.strain_gauge.data(), row, force, rows, components, strain);
  } else {
    for (std::int32_t r = 0; r < rows; ++r) {  // bound: 3 kMaxContacts, of one gauge
      for (std::int32_t c = 0; c < components; ++c)
        strain[c] += model.strain_gauge[static_cast<std::size_t>(row[r] + c)] * force[r];
    }
  }
  Real largest2 = 0;
  for (std::int32_t c = 0; c < components; c += 6) {  // bound: kMaxStrainGauges
    Real e[6];
    for (int k = 0; k < 6; ++k) e[k] = static_cast<Real>(strain[c + k]);
    const Real sum = e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + 2 * (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
    largest2 = max_of(largest2, sum);
  }
  return square_root(2.0 / 3.0 * largest2);
}

}  // namespace palpate
