// The hand as people draw it: a closed surface for each finger part and for the palm, carried rigidly by its piece.
// Contact uses the pieces' capsules, or points on these surfaces (config/hand/hand_surface.h).
#pragma once

#include "config/body/mesh.h"
#include "rt_core/model.h"

namespace palpate {

// In the piece's frame: z from root to tip, x towards the palm. 5,024 triangles for the whole hand, as in Cui & Xiao
// 2008: 288 for each finger part, 704 for the palm. (Sixteen closed surfaces of 5,024 triangles have 2,544 vertices by
// Euler's formula; the 2,015 printed there cannot be closed surfaces.)
// `left`: of a left hand.
SurfaceMesh hand_piece_mesh(const ToolPiece& piece, bool left = false);

}  // namespace palpate
