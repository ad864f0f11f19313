// hand.contact = "mesh": points on the surface of the hand's mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "config/hand/hand_mesh.h"
#include "config/hand/hand_model.h"
#include "config/hand/hand_surface.h"
#include "rt_core/surface/triangle.h"
#include "tests/articulate/grasp_scenes.h"

namespace palpate::test {
namespace {

Tool mesh_hand(std::int32_t points_per_part) {
  HandDesc hand;
  hand.contact = HandContact::kMesh;
  hand.points_per_part = points_per_part;
  Tool tool = make_tool(make_hand(hand).piece);
  shape_hand_points(hand, tool);
  return tool;
}

Vec3 in_piece(const ToolPiece& piece, const ToolPoint& point) {
  return inverse_transform(piece.pose_tool, point.position_tool_m);
}

double distance_to_m(const SurfaceMesh& mesh, Vec3 p) {
  double least = kHuge;
  for (const Corners& c : mesh.triangle) {
    const auto at = [&](std::size_t k) { return mesh.vertex_m[static_cast<std::size_t>(c[k])]; };
    least = std::min(least, norm(closest_on_triangle(p, at(0), at(1), at(2)).point - p));
  }
  return least;
}

TEST(HandSurface, HasAsManyPointsAsFillItsRows) {
  for (const auto& [asked, given] : {std::pair{2, 2}, {4, 4}, {8, 8}, {9, 9}, {11, 9}, {12, 12}, {25, 25}, {29, 25}}) {
    EXPECT_EQ(surface_point_count(asked), given);
    EXPECT_EQ(mesh_hand(asked).point.size(), static_cast<std::size_t>(kHandParts * given));
  }
}

// Each sphere touches the mesh from inside. Facets are a sixteenth of a turn wide: they cut the round surface that
// their smooth normals stand for by up to r (1 - cos(11.25 degrees)) = 0.02 r.
TEST(HandSurface, PointsTouchTheMeshFromInside) {
  for (const std::int32_t count : {4, 9, 25}) {
    const Tool tool = mesh_hand(count);
    for (const ToolPoint& point : tool.point) {
      const ToolPiece& piece = tool.piece[static_cast<std::size_t>(point.piece)];
      const double r = piece.margin_m, below = distance_to_m(hand_piece_mesh(piece), in_piece(piece, point));
      EXPECT_NEAR(below, point.margin_m, 0.03 * r) << "part " << piece.part << " of " << count;
      EXPECT_GT(in_piece(piece, point).x, 0) << "on the palm's side";
      EXPECT_LE(norm(in_piece(piece, point)) + point.margin_m, piece.bounding_radius_m + 1e-3);
    }
  }
}

// To the bit: a left hand is then the mirror image of the right one.
TEST(HandSurface, IsItsOwnMirrorImage) {
  const Tool tool = mesh_hand(9);
  for (const ToolPiece& piece : tool.piece)
    for (std::int32_t i = piece.first_point; i < piece.first_point + piece.point_count; ++i) {
      // Columns of a row are three neighbours in the list: left, middle, right.
      const std::int32_t row = piece.first_point + (i - piece.first_point) / 3 * 3;
      const Vec3 p = in_piece(piece, tool.point[static_cast<std::size_t>(i)]);
      const Vec3 q = in_piece(piece, tool.point[static_cast<std::size_t>(2 * row + 2 - i)]);
      EXPECT_NEAR(p.x, q.x, 1e-15);
      EXPECT_NEAR(p.y, -q.y, 1e-15);
      EXPECT_NEAR(p.z, q.z, 1e-15);
    }
}

// Nearer points leave less of the strip uncovered.
TEST(HandSurface, MorePointsCoverMoreOfTheMesh) {
  const Tool four = mesh_hand(4), twelve = mesh_hand(12), many = mesh_hand(50);
  for (std::size_t i = 0; i < kHandParts; ++i) {
    EXPECT_GT(four.gap_m[i], twelve.gap_m[i]);
    EXPECT_GT(twelve.gap_m[i], many.gap_m[i]);
    EXPECT_LT(many.gap_m[i], 0.5e-3 + 0.1 * many.piece[i].half_extent_m[2]);
  }
}

GraspRun grasp_with_mesh(const std::string& name, const std::string& points) {
  const std::string scenes = std::string(PALPATE_SOURCE_DIR) + "/config/scenes/";
  const SceneModel scene(scenes + name + ".toml",
                         {{scenes + "hands/mesh_contact.toml"}, {"hand.points_per_part=" + points}});
  return run_grasp(scene.model(), *scene.scene(), {});
}

// The mesh's pads stand out from the table's rods by 4 to 8 % of the radius and its knuckles do not, so that the forces
// of a grasp are of the same size and are not the same.
TEST(HandSurface, GraspsWithItsPadsAndKnuckles) {
  const GraspRun& rods = played("grasp_cylinder_5");
  const GraspRun mesh = grasp_with_mesh("grasp_cylinder_5", "4");
  EXPECT_EQ(mesh.regions, kHandParts);
  EXPECT_TRUE(mesh.back_at_rest);
  double sum = 0, rod_sum = 0;
  for (std::size_t part = 1; part <= kHandParts; ++part) {
    EXPECT_GT(mesh.part_force_N[part], 0.05) << part;
    sum += mesh.part_force_N[part];
    rod_sum += rods.part_force_N[part];
  }
  // Every part closes until its deepest point is 3 mm deep, rods and mesh alike. The mesh's other points lie lower by
  // up to 0.08 of 8.5 mm, and the force goes with the cube of the depth: 1 - (2.3 / 3)^3 = 55 % of it may be lost.
  EXPECT_LT(sum, rod_sum);  // 8.90 and 9.87 N on 2026-11-23
  EXPECT_GT(sum, 0.45 * rod_sum);
  EXPECT_GT(force_difference(rods, mesh), 0.01);
}

TEST(HandSurface, ThumbAndIndexHaveRoomForNinePointsAPart) {
  const GraspRun mesh = grasp_with_mesh("grasp_cylinder_2", "9");
  EXPECT_EQ(mesh.regions, 6);
  EXPECT_LE(mesh.held->high_water.contacts, 54);
  EXPECT_GT(mesh.held->high_water.contacts, 24) << "points beside the middle line touch too";
  EXPECT_TRUE(mesh.back_at_rest);
}

}  // namespace
}  // namespace palpate::test
