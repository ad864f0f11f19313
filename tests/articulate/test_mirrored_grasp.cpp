// A left hand that grasps the mirror image of what a right hand grasps feels the mirror image of its forces.
#include <gtest/gtest.h>

#include <cmath>

#include "config/bake/tool_points.h"
#include "config/hand/hand_mesh.h"
#include "config/hand/hand_model.h"
#include "rt_core/tool/articulate.h"
#include "sim_host/press/grasp_run.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

// The world's mirror image in z = 0 of a pose of a right hand, as a pose of the left hand, which is the right hand's
// image in y = 0 of its own frame: S_z R S_y = (S_z R S_z) (S_z S_y), and S_z S_y is half a turn about x.
Vec3 mirrored_rotation(Vec3 rotation_rad) {
  const Quat q = rotation_of({-rotation_rad.x, -rotation_rad.y, rotation_rad.z}) * Quat{0, 1, 0, 0};
  const Vec3 axis{q.x, q.y, q.z};
  const double sine = norm(axis);
  return sine > 1e-12 ? (2 * std::atan2(sine, q.w) / sine) * axis : Vec3{};
}
Vec3 mirrored(Vec3 p) { return {p.x, p.y, -p.z}; }

SceneDesc right_scene(const std::string& name) {
  return load_scene(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/" + name + ".toml");
}
SceneDesc left_scene(const std::string& name) {
  SceneDesc scene = right_scene(name);
  scene.hand.side = HandSide::kLeft;
  scene.hand.grasp_position_m = mirrored(scene.hand.grasp_position_m);
  scene.hand.grasp_rotation_rad = mirrored_rotation(scene.hand.grasp_rotation_rad);
  for (PathPoint& point : scene.path.point) {
    point.position_m = mirrored(point.position_m);
    point.rotation_rad = mirrored_rotation(point.rotation_rad);
  }
  return scene;
}

std::size_t mirrored_anchor(const Model& model, std::size_t a) {
  const Vec3 p = mirrored(model.anchor[a].position_m);
  for (std::size_t b = 0; b < model.anchor.size(); ++b)
    if (norm(model.anchor[b].position_m - p) < 1e-9) return b;
  ADD_FAILURE() << "no mirror image of anchor " << a;
  return a;
}

// 1e-9 is the bound for forces (N) and, of the largest, for stresses; measured 2026-11-21: 1.3e-10 N
// and 2.4e-11.
void expect_mirror_images(const std::string& name, double hand_N_per_m) {
  const SceneDesc right = right_scene(name), left = left_scene(name);
  const BakedScene baked(right), image(left);
  GraspOptions options;
  options.hand_N_per_m = hand_N_per_m;
  const GraspRun a = run_grasp(baked.model(), right, options), b = run_grasp(image.model(), left, options);
  ASSERT_EQ(a.regions, b.regions);
  ASSERT_GT(a.regions, 5);
  for (std::size_t part = 0; part < a.part_force_N.size(); ++part)
    EXPECT_NEAR(a.part_force_N[part], b.part_force_N[part], 1e-9) << name << " part " << part;
  EXPECT_LE(norm(a.contact_w.force_N - mirrored(b.contact_w.force_N)), 1e-9) << name;
  EXPECT_LE(norm(a.contact_w.torque_Nm + mirrored(b.contact_w.torque_Nm)), 1e-9) << name;  // turns mirror the other way
  EXPECT_LE(norm(a.palm_w.force_N - mirrored(b.palm_w.force_N)), 1e-9) << name;
  double most = 0, difference = 0;
  for (std::size_t k = 0; k < a.stress_Pa.size(); ++k) {
    const std::size_t m = mirrored_anchor(baked.model(), k);
    ASSERT_EQ(a.stress_Pa[k].size(), b.stress_Pa[m].size());
    for (std::size_t i = 0; i < a.stress_Pa[k].size(); ++i) {
      most = std::max(most, a.stress_Pa[k][i]);
      difference = std::max(difference, std::abs(a.stress_Pa[k][i] - b.stress_Pa[m][i]));
    }
  }
  EXPECT_GT(most, 0);
  EXPECT_LE(difference, 1e-9 * most) << name;
}

TEST(MirroredGrasp, OfACylinderIsTheMirrorImage) {
  for (const char* name : {"grasp_cylinder_2", "grasp_cylinder_5"}) expect_mirror_images(name, 0);
}

TEST(MirroredGrasp, OfASphereIsTheMirrorImage) {
  for (const char* name : {"grasp_sphere_3", "grasp_sphere_5"}) expect_mirror_images(name, 0);
}

// The wrist gives way then: the contact's 6x6 tangent and the coupling's balance mirror too.
TEST(MirroredGrasp, WithACompliantWristToo) { expect_mirror_images("grasp_cylinder_5", 2000); }

TEST(LeftHand, IsTheMirrorImageJointByJoint) {
  HandDesc left_desc;
  left_desc.side = HandSide::kLeft;
  const HandTool right = make_hand({}), left = make_hand(left_desc);
  Model a, b;
  a.joint = right.joint;
  b.joint = left.joint;
  EXPECT_FALSE(is_left_hand(a));
  EXPECT_TRUE(is_left_hand(b));
  double q[kMaxJoints];
  for (std::size_t j = 0; j < kMaxJoints; ++j) q[j] = 0.1 + 0.02 * static_cast<double>(j);
  Pose link_a[kMaxJoints], link_b[kMaxJoints];
  place_links(a, q, link_a, nullptr, nullptr);
  place_links(b, q, link_b, nullptr, nullptr);
  for (std::size_t j = 0; j < kMaxJoints; ++j) {
    const Vec3 p = transform(link_a[j], {0.01, 0.02, 0.03}), m = transform(link_b[j], {0.01, -0.02, 0.03});
    EXPECT_LE(norm(m - Vec3{p.x, -p.y, p.z}), 1e-15) << j;
  }
}

TEST(LeftHand, ItsDrawnPalmIsClosedAndHasTheThumbOnTheOtherSide) {
  const Tool tool = make_tool(make_hand({}).piece);
  const ToolPiece& palm = tool.piece.back();
  const SurfaceMesh right = hand_piece_mesh(palm), left = hand_piece_mesh(palm, true);
  EXPECT_NO_THROW(check_mesh(left, "palm"));
  EXPECT_NEAR(bounds_of(left).lower_m.y, -bounds_of(right).upper_m.y, 1e-15);
  EXPECT_NEAR(signed_volume_m3(left), signed_volume_m3(right), 1e-15);
}

}  // namespace
}  // namespace palpate::test
