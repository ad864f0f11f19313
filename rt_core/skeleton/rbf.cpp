#include "rt_core/skeleton/rbf.h"

namespace palpate {
namespace {

// s near an anchor is -2 |p - x_i|: closer than half a millionth of the body, p and the anchor are the same point.
constexpr Real kAtAnchor = 1e-6;

const Real* row_of(const Model& model, std::int32_t row) PALPATE_RT {
  return model.rbf_inverse.data() + row * model.sizes.n_rbf;
}

}  // namespace

bool rbf_available(const Model& model) PALPATE_RT {
  const std::int64_t n = model.sizes.n_rbf;
  const std::int64_t anchors = model.sizes.n_anchor;
  return anchors > 0 && anchors <= kMaxAnchors && n == anchors + rbf_tail_size(model.params.rbf_tail) &&
         static_cast<std::int64_t>(model.anchor.size()) >= anchors &&
         static_cast<std::int64_t>(model.rbf_inverse.size()) >= n * n;
}

void rbf_terms(const Model& model, Vec3 x, RbfVector& g) PALPATE_RT {
  const auto anchors = static_cast<std::int32_t>(model.sizes.n_anchor);
  for (std::int32_t i = 0; i < anchors; ++i) g[i] = norm(x - model.anchor[static_cast<std::size_t>(i)].position_m);
  g[anchors] = 1;
  if (model.params.rbf_tail != 1) return;
  g[anchors + 1] = x.x;
  g[anchors + 2] = x.y;
  g[anchors + 3] = x.z;
}

void rbf_multiply(const Model& model, const RbfVector& g, RbfVector& q) PALPATE_RT {
  const auto n = static_cast<std::int32_t>(model.sizes.n_rbf);
  for (std::int32_t i = 0; i < n; ++i) {  // <= kMaxRbf
    const Real* row = row_of(model, i);
    Real sum = 0;
    for (std::int32_t j = 0; j < n; ++j) sum += row[j] * g[j];
    q[i] = sum;
  }
}

void rbf_weights(const Model& model, Vec3 x, RbfVector& weight) PALPATE_RT {
  RbfVector g{};
  rbf_terms(model, x, g);
  rbf_multiply(model, g, weight);
}

void rbf_coefficients(const Model& model, const Vec3* displacement, Vec3 (&coefficient)[kMaxRbf]) PALPATE_RT {
  const auto n = static_cast<std::int32_t>(model.sizes.n_rbf);
  const auto anchors = static_cast<std::int32_t>(model.sizes.n_anchor);
  for (std::int32_t i = 0; i < n; ++i) {
    const Real* row = row_of(model, i);
    Vec3 sum;
    for (std::int32_t j = 0; j < anchors; ++j) sum += row[j] * displacement[j];
    coefficient[i] = sum;
  }
}

Vec3 rbf_value(const Model& model, const RbfVector& g, const Vec3 (&coefficient)[kMaxRbf]) PALPATE_RT {
  const auto n = static_cast<std::int32_t>(model.sizes.n_rbf);
  Vec3 sum;
  for (std::int32_t i = 0; i < n; ++i) sum += g[i] * coefficient[i];
  return sum;
}

void make_rbf_contact(const Model& model, Vec3 point_w, RbfContact& contact) PALPATE_RT {
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

Real rbf_contact_weight(const Model& model, const RbfContact& contact, const RbfVector& g, Vec3 x) PALPATE_RT {
  const auto n = static_cast<std::int32_t>(model.sizes.n_rbf);
  Real sum = norm(x - contact.point_w);
  for (std::int32_t i = 0; i < n; ++i) sum -= g[i] * contact.q[i];
  return sum * contact.inverse_s;
}

}  // namespace palpate
