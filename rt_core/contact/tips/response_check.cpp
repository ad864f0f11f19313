#include "rt_core/contact/tips/response_check.h"

namespace palpate {

namespace {

using std::int64_t;

bool in_range(int64_t index, std::size_t size) noexcept { return index >= 0 && index < static_cast<int64_t>(size); }
bool is_unit(Vec3 v) noexcept { return squared_norm(v) > 0.99 && squared_norm(v) < 1.01; }

ImageResult broken(const char* field, std::size_t index) noexcept {
  return {ImageError::kCrossReference, field, static_cast<int64_t>(index)};
}
ImageResult not_finite(const char* field, std::size_t index) noexcept {
  return {ImageError::kNotFinite, field, static_cast<int64_t>(index)};
}

// Factor tables and the range of each tip law, so that the tick may index and divide.
ImageResult check_tip_laws(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.tip_law.size(); ++i) {
    const TipLaw& law = model.tip_law[i];
    if (law.half_power < 2 || law.half_power > 4) return broken("tip_law.half_power", i);
    const bool has_factor = law.first_factor >= 0;
    if (law.first_factor < -1 || (has_factor && int64_t{law.first_factor} + kFactorKnots > model.sizes.n_factor))
      return broken("tip_law.first_factor", i);
    const double sizes[] = {law.coefficient, law.depth_max_m, law.force_max_N};
    for (const double size : sizes)
      if (!(size > 0 && size < kHuge)) return not_finite("tip_law", i);
    if (!is_finite(law.c0_m_per_N) || !is_finite(law.c1_m_per_N2)) return not_finite("tip_law.c0_m_per_N", i);
  }
  for (std::size_t i = 0; i < model.factor.size(); ++i) {
    const FactorKnot& knot = model.factor[i];
    if (!is_finite(knot.value) || !is_finite(knot.slope) || !is_finite(knot.energy_J)) return not_finite("factor", i);
  }
  for (std::size_t i = 0; i < model.tip_pair.size(); ++i) {
    const TipPair& pair = model.tip_pair[i];
    if (!in_range(pair.piece_a, model.piece.size()) || !in_range(pair.piece_b, model.piece.size()))
      return broken("tip_pair.piece", i);
    if (!is_finite(pair.c_m_per_N) || !is_finite(pair.h_ab_m_per_N2) || !is_finite(pair.h_ba_m_per_N2))
      return not_finite("tip_pair", i);
  }
  return {};
}

// Curves: knots strictly ascending from zero, whole rows, forces that start at zero and never fall.
ImageResult check_tables(const Model& model) noexcept {
  const std::size_t knots = model.knot.size();
  if (knots < 2 || model.knot[0] != 0) return broken("knot", 0);
  for (std::size_t i = 1; i < knots; ++i)
    if (!(model.knot[i] > model.knot[i - 1] && model.knot[i] < kHuge)) return not_finite("knot", i);
  if (model.response.empty() || model.response.size() % knots != 0) return broken("n_response", 0);
  const bool root = model.params.response_root == 1;
  for (std::size_t i = 0; i < model.response.size(); ++i) {
    const ResponseKnot& r = model.response[i];
    const bool first = i % knots == 0;
    if (!(r.force_N >= 0 && r.force_N < kHuge && r.slope >= 0 && r.slope < kHuge && is_finite(r.energy_J)))
      return not_finite("response", i);
    // In the root of the depth a slope at zero would be an infinite stiffness.
    if (first ? r.force_N != 0 || (root && r.slope != 0) : r.force_N < model.response[i - 1].force_N)
      return broken("response", i);
  }
  if (model.vertex_response.size() != model.vertex_m.size()) return broken("vertex_response", 0);
  for (std::size_t i = 0; i < model.vertex_response.size(); ++i)
    if (!in_range(model.vertex_response[i], model.response.size() / knots)) return broken("vertex_response", i);
  return {};
}

}  // namespace

ImageResult check_response(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.corner_normal.size(); ++i)
    for (const Vec3& normal : model.corner_normal[i].normal)
      if (!is_unit(normal)) return not_finite("corner_normal", i);
  const auto law = model.params.response_law;
  if (!model.corner_normal.empty() && model.corner_normal.size() != model.triangle.size()) return broken("n_corner", 0);
  if (law == ResponseLaw::kPoints) return {};
  if (model.corner_normal.empty()) return broken("n_corner", 0);
  if (law != ResponseLaw::kTip) return check_tables(model);
  if (model.tip_law.size() != model.piece.size()) return broken("n_tip_law", 0);
  return check_tip_laws(model);
}

}  // namespace palpate
