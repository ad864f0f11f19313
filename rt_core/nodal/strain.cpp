#include "rt_core/nodal/strain.h"

#include <utility>

namespace palpate {

namespace {

// Components of one pass over the pushing nodes: what the registers hold.
constexpr std::int32_t kPass = 96;
static_assert(6 * kMaxStrainGauges % kPass == 0, "passes are whole");

// Adds kPass strain components of all pushes, eight of them for each k. Single precision, as the gauges are.
template <int... k>
void add_pass(const float* gauges, const std::int32_t* row, const float* force, std::int32_t rows, float* strain,
              std::integer_sequence<int, k...>) PALPATE_RT {
  Float8 sum[] = {load8(strain + 8 * k)...};
  for (std::int32_t r = 0; r < rows; ++r) {  // bound: 3 kMaxContacts
    const Float8 f = splat8(force[r]);
    const float* from = gauges + row[r];
    ((sum[k] += load8(from + 8 * k) * f), ...);
  }
  (store(strain + 8 * k, sum[k]), ...);
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
  std::int32_t done = 0;
  for (; done + kPass <= components; done += kPass)  // bound: 1
    add_pass(model.strain_gauge.data() + done, row, force, rows, strain + done,
             std::make_integer_sequence<int, kPass / 8>());
  for (std::int32_t r = 0; r < rows && done < components; ++r) {  // bound: 3 kMaxContacts, kPass components each
    const float* from = model.strain_gauge.data() + row[r];
    for (std::int32_t c = done; c < components; ++c) strain[c] += from[c] * force[r];
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
