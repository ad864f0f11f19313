#include "rt_core/skeleton/rbf.h"

namespace palpate {
namespace {

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
  if (model.params.rbf_tail != RbfTail::kLinear) return;
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

}  // namespace palpate
