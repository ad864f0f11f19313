#include "rt_core/nodal/strain.h"

namespace palpate {

Real largest_strain(const Model& model, const ContactProblem& p) PALPATE_RT {
  const auto components = static_cast<std::int32_t>(model.sizes.n_strain_gauge / (3 * model.sizes.n_vertex));
  Real strain[6 * kMaxStrainGauges] = {};
  for (std::int32_t i = 0; i < p.count; ++i) {  // bound: kMaxContacts
    if (!(p.node[i].push.normal_N > 0)) continue;
    const Vec3 f = push_w(p.node[i]);
    const Real force[3] = {f.x, f.y, f.z};
    const float* row = model.strain_gauge.data() + static_cast<std::size_t>(3 * p.node[i].vertex * components);
    for (int a = 0; a < 3; ++a, row += components) {
      for (std::int32_t c = 0; c < components; ++c) strain[c] += static_cast<Real>(row[c]) * force[a];
    }
  }
  Real largest2 = 0;
  for (std::int32_t c = 0; c < components; c += 6) {  // bound: kMaxStrainGauges
    const Real* e = strain + c;
    const Real sum = e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + 2 * (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
    largest2 = max_of(largest2, sum);
  }
  return square_root(2.0 / 3.0 * largest2);
}

}  // namespace palpate
