#include "sim_host/view/rbf_surface.h"

namespace palpate {
namespace {

// s near an anchor is -2 |p - x_i|: closer than half a millionth of the body, p and the anchor are the same point.
constexpr Real kAtAnchor = 1e-6;

}  // namespace

void rbf_coefficients(const Model& model, const Vec3* displacement, Vec3 (&coefficient)[kMaxRbf]) {
  const auto n = static_cast<std::int32_t>(model.sizes.n_rbf);
  const auto anchors = static_cast<std::int32_t>(model.sizes.n_anchor);
  for (std::int32_t i = 0; i < n; ++i) {
    const Real* row = model.rbf_inverse.data() + i * n;
    Vec3 sum;
    for (std::int32_t j = 0; j < anchors; ++j) sum += row[j] * displacement[j];
    coefficient[i] = sum;
  }
}

Vec3 rbf_value(const Model& model, const RbfVector& g, const Vec3 (&coefficient)[kMaxRbf]) {
  const auto n = static_cast<std::int32_t>(model.sizes.n_rbf);
  Vec3 sum;
  for (std::int32_t i = 0; i < n; ++i) sum += g[i] * coefficient[i];
  return sum;
}

void make_rbf_contact(const Model& model, Vec3 point_w, RbfContact& contact) {
  contact.point_w = point_w;
  contact.inverse_s = 0;
  contact.at_anchor = -1;
  RbfVector g{};
  rbf_terms(model, point_w, g);
  rbf_multiply(model, g, contact.q);
  const auto n = static_cast<std::int32_t>(model.sizes.n_rbf);
  Real s = 0;
  for (std::int32_t i = 0; i < n; ++i) s -= g[i] * contact.q[i];
  if (abs_of(s) > kAtAnchor * model.params.surface_size_m) {
    contact.inverse_s = 1.0 / s;
    return;
  }
  Real nearest = kHuge;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(model.sizes.n_anchor); ++i) {
    if (g[i] < nearest) {
      nearest = g[i];
      contact.at_anchor = i;
    }
  }
}

Real rbf_contact_weight(const Model& model, const RbfContact& contact, const RbfVector& g, Vec3 x) {
  const auto n = static_cast<std::int32_t>(model.sizes.n_rbf);
  Real sum = norm(x - contact.point_w);
  for (std::int32_t i = 0; i < n; ++i) sum -= g[i] * contact.q[i];
  return sum * contact.inverse_s;
}

}  // namespace palpate
