// The drawn hand: closed surfaces of the promised size that cover the contact shapes.
#include <gtest/gtest.h>

#include "config/bake/tool_points.h"
#include "config/hand/hand_mesh.h"
#include "config/hand/hand_model.h"

namespace palpate {
namespace {

TEST(HandMesh, EveryPieceIsAClosedOutwardSurfaceAndTheWholeHas5024Triangles) {
  const Tool tool = make_tool(make_hand({}).piece);
  std::size_t triangles = 0, vertices = 0;
  for (const ToolPiece& piece : tool.piece) {
    const SurfaceMesh mesh = hand_piece_mesh(piece);
    EXPECT_NO_THROW(check_mesh(mesh, "part " + std::to_string(piece.part)));
    triangles += mesh.triangle.size();
    vertices += mesh.vertex_m.size();
  }
  EXPECT_EQ(triangles, 5024u);
  EXPECT_EQ(vertices, 2544u);  // V = F/2 + 2 for each of 16 closed surfaces
}

// The capsule that touches must not stick out of the finger that is drawn by more than a millimetre.
TEST(HandMesh, TheDrawnFingerCoversItsCapsule) {
  const Tool tool = make_tool(make_hand({}).piece);
  for (const ToolPiece& piece : tool.piece) {
    if (piece.part == kPalmPart) continue;
    const Bounds bounds = bounds_of(hand_piece_mesh(piece));
    const double r = piece.margin_m, reach = piece.half_extent_m[2] + r;
    EXPECT_LE(bounds.lower_m.z, -reach);
    EXPECT_GE(bounds.upper_m.z, reach - 1e-3);
    EXPECT_GE(bounds.upper_m.x, r - 1e-3);
    EXPECT_GE(bounds.upper_m.y, r - 1e-3);
    EXPECT_LE(bounds.upper_m.y, 1.2 * r);
  }
}

}  // namespace
}  // namespace palpate
