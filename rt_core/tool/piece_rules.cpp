#include "rt_core/tool/piece_rules.h"

#include "rt_core/tool/shapes.h"

namespace palpate {

ImageResult check_method(const Model& model) noexcept {
  const Method method = method_of(model.params);
  const bool nodes = method == Method::kNodes, tips = method == Method::kTips;
  if ((methods_of(model.params.friction_law) & bit_of(method)) == 0) return {ImageError::kCombination, "friction_law"};
  for (std::size_t i = 0; i < model.piece.size(); ++i) {
    const ToolPiece& piece = model.piece[i];
    if (nodes && !has_gap(piece.shape))
      return {ImageError::kCombination, "piece.nodal_shape", static_cast<std::int64_t>(i)};
    if (tips && piece.point_count > 1)
      return {ImageError::kCombination, "piece.tip_points", static_cast<std::int64_t>(i)};
  }
  return {};
}

}  // namespace palpate
