// A tool point's tip as the tool carries it: ball, line or plate.
#include "rt_core/contact/elastic/linearised.h"

namespace palpate {

RoundTip round_tip(const Model& model, std::int32_t index, const Pose& carrier) PALPATE_RT {
  const ToolPoint& point = model.tool_point[static_cast<std::size_t>(index)];
  const ToolPiece& piece = model.piece[static_cast<std::size_t>(point.piece)];
  RoundTip tip;
  tip.margin_m = point.margin_m;
  tip.middle_w = transform(carrier, point.position_tool_m);
  tip.begins_at = point.begins_at;
  if (piece.shape == PieceShape::kCapsule && point.position_tool_m == piece.pose_tool.position_m)
    tip.half_axis_w =
        rotate(carrier.orientation, rotate(piece.pose_tool.orientation, Vec3{0, 0, piece.half_extent_m[2]}));
  if (piece.shape == PieceShape::kBox) {
    const Quat turn = carrier.orientation * piece.pose_tool.orientation;
    tip.half_axis_w = rotate(turn, Vec3{piece.half_extent_m[0], 0, 0});
    tip.half_across_w = rotate(turn, Vec3{0, piece.half_extent_m[1], 0});
  }
  if (tip.is_ball()) return tip;
  const TipLaw& law = model.tip_law[static_cast<std::size_t>(point.piece)];
  tip.depth_max_m = law.depth_max_m;
  if (piece.shape == PieceShape::kBox) {
    const Real nu = model.params.poisson_ratio;
    tip.modulus_Pa = model.params.youngs_modulus_Pa / (1 - nu * nu);
    tip.flat_m = 0.5 * law.coefficient / tip.modulus_Pa;
  } else {
    tip.modulus_Pa = 0.75 * law.coefficient / square_root(tip.margin_m);
    for (int i = 0; i < 2; ++i) tip.leaves[i] = piece.half_extent_m[i];  // bound: 2
  }
  return tip;
}

}  // namespace palpate
