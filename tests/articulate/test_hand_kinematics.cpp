// Forward kinematics of the hand against closed forms and worked numbers, Table I of Cui & Xiao 2008, joint limits.
#include <gtest/gtest.h>

#include <cmath>

#include "config/hand/hand_model.h"
#include "rt_core/tool/articulate.h"
#include "rt_core/tool/carrier_frames.h"

namespace palpate {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

std::vector<Vec3> places(const std::vector<Joint>& chain, const std::vector<double>& degrees) {
  Model model;
  model.joint = chain;
  std::vector<double> q;
  for (const double d : degrees) q.push_back(d * kDegree);
  Pose link[kMaxJoints];
  place_links(model, q.data(), link, nullptr, nullptr);
  std::vector<Vec3> at;
  for (std::size_t j = 0; j < chain.size(); ++j) at.push_back(1e3 * link[j].position_m);
  return at;
}

void expect_near(Vec3 a, Vec3 b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(HandKinematics, FramesByFoursAreTheSameToTheBit) {
  const auto pose = [](int i) {
    const double t = 0.37 * i;
    return Pose{{std::sin(t), std::cos(2 * t), 0.1 * t}, normalised({std::cos(t), std::sin(t), std::sin(3 * t), 0.2})};
  };
  const Pose tool = pose(40);
  std::vector<Pose> motion;
  for (int n = 1; n <= kMaxPieces; ++n) {
    motion.push_back(pose(n));
    CarrierFrames frames;
    frames.place(tool, motion.data(), n);
    for (int i = 0; i < n; ++i) {
      const RigidFrame one(tool * motion[static_cast<std::size_t>(i)]);
      const RigidLanes of_four = frames.of(i);
      EXPECT_EQ(one.x, vector_of(of_four.x)) << n << ' ' << i;
      EXPECT_EQ(one.y, vector_of(of_four.y));
      EXPECT_EQ(one.z, vector_of(of_four.z));
      EXPECT_EQ(one.origin, vector_of(of_four.origin));
    }
  }
}

// Index finger of Table I, psi = 10, theta = 40, 50, 30 degrees; numbers computed independently, to their last digit.
TEST(HandKinematics, AFingerReachesTheWorkedPlaces) {
  const std::vector<Vec3> at = places(finger_chain({}, {0.0269, 0.0215, 0.0251}, 0, 1, 1), {10, 40, 50, 30});
  expect_near(at[1], {20.293535, 3.578298, -17.290987}, 5e-7);
  expect_near(at[2], {20.293535, 3.578298, -38.790987}, 5e-7);
  expect_near(at[3], {7.934198, 1.399013, -60.528224}, 5e-7);
}

TEST(HandKinematics, TheThumbReachesTheWorkedPlaces) {
  const std::vector<Vec3> at = places(thumb_chain({}, {0.0389, 0.0335, 0.0269}, 1), {20, 15, 5, 30, 25});
  expect_near(at[1], {35.308494, 12.851241, -10.068061}, 5e-7);
  expect_near(at[3], {56.602985, 23.292628, -33.727565}, 5e-7);
  expect_near(at[4], {64.735256, 27.683579, -58.990100}, 5e-7);
}

// X = L1 c1 + L2 c12 + L3 c123, Z = -(L1 s1 + L2 s12 + L3 s123), turned by psi about z.
TEST(HandKinematics, AFingerFollowsItsClosedFormEverywhere) {
  const std::array<double, 3> l{0.0303, 0.0243, 0.0272};
  const std::vector<Joint> chain = finger_chain({}, l, 0, 2, 1);
  for (double psi = -15; psi <= 15; psi += 7.5)
    for (double a = -20; a <= 90; a += 22)
      for (double b = 0; b <= 105; b += 35)
        for (double c = 0; c <= 80; c += 40) {
          const double t1 = a * kDegree, t2 = t1 + b * kDegree, t3 = t2 + c * kDegree, p = psi * kDegree;
          const double x = 1e3 * (l[0] * std::cos(t1) + l[1] * std::cos(t2) + l[2] * std::cos(t3));
          const double z = -1e3 * (l[0] * std::sin(t1) + l[1] * std::sin(t2) + l[2] * std::sin(t3));
          expect_near(places(chain, {psi, a, b, c})[3], {x * std::cos(p), x * std::sin(p), z}, 1e-11);
        }
}

TEST(Hand, HasTheJointsPartsAndSizesOfTheTable) {
  const HandTool hand = make_hand({});
  ASSERT_EQ(hand.joint.size(), 21u);
  ASSERT_EQ(hand.piece.size(), 16u);       // 15 parts and the palm
  EXPECT_EQ(hand.piece.back().points, 0);  // supports, never deforms
  bool seen[kHandParts + 1] = {};
  for (std::size_t i = 0; i < 15; ++i) {
    const PieceDesc& piece = hand.piece[i];
    ASSERT_GE(piece.part, 1);
    ASSERT_LE(piece.part, kHandParts);
    EXPECT_FALSE(seen[piece.part]);
    seen[piece.part] = true;
    const HandPart& row = hand_parts()[static_cast<std::size_t>(piece.part - 1)];
    EXPECT_DOUBLE_EQ(piece.radius_m, 0.5 * row.width_m);
    EXPECT_LT(piece.length_m, row.length_m + row.width_m);
  }
  EXPECT_DOUBLE_EQ(hand_parts()[0].length_m, 0.0251);
  EXPECT_DOUBLE_EQ(hand_parts()[14].length_m, 0.0389);
  // Table I in full: sum of lengths and widths.
  double length = 0, width = 0;
  for (const HandPart& part : hand_parts()) length += part.length_m, width += part.width_m;
  EXPECT_NEAR(length, 0.3792, 1e-12);
  EXPECT_NEAR(width, 0.190, 1e-12);
}

TEST(Hand, EveryFingerHasItsJointsInOrder) {
  const HandTool hand = make_hand({});
  for (std::int32_t finger = 0; finger < kMaxFingers; ++finger) {
    const FingerJoints joints = finger_joints(finger);
    EXPECT_EQ(joints.count, finger == 0 ? 5 : 4);
    for (std::int32_t j = joints.first; j < joints.first + joints.count; ++j) {
      const Joint& joint = hand.joint[static_cast<std::size_t>(j)];
      EXPECT_EQ(joint.finger, finger);
      EXPECT_EQ(joint.parent, j == joints.first ? -1 : j - 1);
      EXPECT_LT(joint.lowest, joint.highest);
      EXPECT_GE(joint.open, joint.lowest);
      EXPECT_LE(joint.open, joint.highest);
    }
  }
}

// With every joint at zero no piece has moved from where the image describes it.
TEST(Hand, ZeroIsZero) {
  const HandTool hand = make_hand({});
  Model model;
  model.joint = hand.joint;
  const double zero[kMaxJoints] = {};
  Pose link[kMaxJoints];
  place_links(model, zero, link, nullptr, nullptr);
  for (std::size_t j = 0; j < hand.joint.size(); ++j) {
    const Pose motion = link[j] * hand.joint[j].zero_inverse;
    EXPECT_LE(norm(motion.position_m), 1e-15);
    EXPECT_NEAR(std::abs(motion.orientation.w), 1, 1e-15);
  }
}

// Bending a finger brings its tip to the palm's side (-z) and never to the back, and the thumb's across the palm (+x).
TEST(Hand, FingersBendTowardsThePalmAndTheThumbAcrossIt) {
  const HandTool hand = make_hand({});
  Model model;
  model.joint = hand.joint;
  double q[kMaxJoints] = {}, bent[kMaxJoints] = {};
  for (std::int32_t f = 0; f < kMaxFingers; ++f)
    for (const std::int32_t j : finger_joints(f).flexion) bent[j] = 0.5;
  Pose straight[kMaxJoints], curled[kMaxJoints];
  place_links(model, q, straight, nullptr, nullptr);
  place_links(model, bent, curled, nullptr, nullptr);
  for (std::int32_t f = 1; f < kMaxFingers; ++f) {
    const auto tip = static_cast<std::size_t>(finger_joints(f).flexion[2]);
    EXPECT_LT(curled[tip].position_m.z, straight[tip].position_m.z - 0.02);
  }
  const auto thumb = static_cast<std::size_t>(finger_joints(0).flexion[2]);
  EXPECT_GT(curled[thumb].position_m.x, straight[thumb].position_m.x + 0.02);
}

}  // namespace
}  // namespace palpate
