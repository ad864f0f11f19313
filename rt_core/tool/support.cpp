#include "rt_core/tool/support.h"

#include "rt_core/tool/shapes.h"

namespace palpate {

Vec3 core_support(const ToolPiece& piece, std::span<const Vec3> hull, Vec3 direction) PALPATE_RT {
  switch (piece.shape) {
#define PALPATE_SHAPE(name, word, Shape) \
  case PieceShape::name:                 \
    return Shape::support(piece, hull, direction);
    PALPATE_PIECE_SHAPES(PALPATE_SHAPE)
#undef PALPATE_SHAPE
  }
  return {};
}

std::span<const Vec3> hull_of(const Model& model, const ToolPiece& piece) PALPATE_RT {
  if (piece.shape != PieceShape::kHull || piece.hull_count <= 0) return {};
  const auto first = static_cast<std::size_t>(piece.first_hull);
  return {model.hull_vertex_m.data() + first, static_cast<std::size_t>(piece.hull_count)};
}

}  // namespace palpate
