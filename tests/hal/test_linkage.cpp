// Kinematics of devices that report joints: against finite differences, virtual work, worked positions and their own
// inverse, which is derived by other means (one leg at a time, from the law of cosines).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "hal/device/linkage.h"

namespace palpate {
namespace {

struct Case {
  std::string name;
  Linkage linkage;
  double lowest[kMaxAxes], highest[kMaxAxes];  // joints well within the workspace
};

std::vector<Case> cases() {
  // Lengths: a Phantom 1.5's (Cavusoglu, Feygin & Tendick 2002 by way of published models: 0.2096 and 0.1695 m); a
  // delta of about an omega's size; a five-bar of round numbers.
  return {{"cartesian", {LinkageKind::kCartesian}, {-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}},
          {"serial", {LinkageKind::kSerial3r, false, 0.20955, 0.169545}, {-1, 0.6, -1.2}, {1, 1.4, 0.2}},
          {"gimbal",
           {LinkageKind::kSerial3r, true, 0.20955, 0.169545},
           {-1, 0.6, -1.2, -2, -1.2, -2},
           {1, 1.4, 0.2, 2, 1.2, 2}},
          {"delta", {LinkageKind::kDelta, false, 0.1, 0.2, 0.09, 0.03}, {-0.3, -0.3, -0.3}, {0.8, 0.8, 0.8}},
          // A Falcon's lengths (libnifalcon, after Stamper 1997).
          {"hinged delta",
           {LinkageKind::kDelta, false, 0.06, 0.1025, 0.03723, 0.014, 0.0225, 0.00233},
           {0, 0, 0},
           {1.2, 1.2, 1.2}},
          {"five bar", {LinkageKind::kFiveBar, false, 0.1, 0.15, 0.1}, {1.6, 0.5}, {2.6, 1.5}}};
}

class Sampler {
 public:
  explicit Sampler(const Case& one) : case_(one) {}
  // Joints at a good place.
  std::vector<double> joints() {
    std::vector<double> q(static_cast<std::size_t>(joint_count(case_.linkage)));
    do {
      for (std::size_t i = 0; i < q.size(); ++i)
        q[i] = std::uniform_real_distribution<>(case_.lowest[i], case_.highest[i])(random_);
      tries_ += 1;
    } while (linkage_at(case_.linkage, q.data()).place != LinkagePlace::kGood);
    return q;
  }
  Vec3 vector(double size) {
    std::uniform_real_distribution<> u(-size, size);
    return {u(random_), u(random_), u(random_)};
  }
  int tries() const { return tries_; }

 private:
  const Case& case_;
  std::mt19937 random_{7};
  int tries_ = 0;
};

Vec3 turn_between(const Pose& from, const Pose& to) {
  return small_rotation_vector(to.orientation * conjugate(from.orientation));
}

constexpr int kSamples = 500;

// Central differences of h = 1e-6: h^2 times a third derivative below 1 m is 1e-12, rounding 1e-16 / h = 1e-10; two
// decades of room.
TEST(Linkage, ItsJacobianIsThatOfFiniteDifferences) {
  constexpr double kStep = 1e-6, kError = 1e-8;
  for (const Case& c : cases()) {
    Sampler sampler(c);
    for (int n = 0; n < kSamples; ++n) {
      std::vector<double> q = sampler.joints();
      const LinkageState here = linkage_at(c.linkage, q.data());
      for (std::size_t i = 0; i < q.size(); ++i) {
        const double at = q[i];
        q[i] = at - kStep;
        const LinkageState before = linkage_at(c.linkage, q.data());
        q[i] = at + kStep;
        const LinkageState after = linkage_at(c.linkage, q.data());
        q[i] = at;
        const Vec3 rate = (0.5 / kStep) * (after.pose.position_m - before.pose.position_m);
        const Vec3 spin = (0.5 / kStep) * turn_between(before.pose, after.pose);
        ASSERT_LT(norm(rate - here.along[i]), kError) << c.name << " joint " << i;
        ASSERT_LT(norm(spin - here.about[i]), kError) << c.name << " joint " << i;
      }
    }
    EXPECT_LT(sampler.tries(), 2 * kSamples) << c.name << ": most of the range must be usable";
  }
}

// tau . dq = F . dx + M . dw for a small move of all joints together: second order in 1e-6 rad times torques below 3 N
// m is 1e-11 J, against 1e-7 J of work.
TEST(Linkage, TorquesDoTheWorkOfTheForce) {
  for (const Case& c : cases()) {
    Sampler sampler(c);
    for (int n = 0; n < kSamples; ++n) {
      std::vector<double> q = sampler.joints();
      const LinkageState here = linkage_at(c.linkage, q.data());
      const Wrench wrench{sampler.vector(10), c.linkage.gimbal ? sampler.vector(0.2) : Vec3{}};
      double torque[kMaxAxes];
      joint_torques(c.linkage, here, wrench, torque);
      double work_J = 0;
      for (std::size_t i = 0; i < q.size(); ++i) {
        const double step = 1e-6 * std::cos(1.0 + static_cast<double>(i + 3) * n);
        work_J += torque[i] * step;
        q[i] += step;
      }
      const LinkageState there = linkage_at(c.linkage, q.data());
      const double felt_J = dot(wrench.force_N, there.pose.position_m - here.pose.position_m) +
                            dot(wrench.torque_Nm, turn_between(here.pose, there.pose));
      ASSERT_NEAR(work_J, felt_J, 1e-10) << c.name;
    }
  }
}

// Away from singular places the law of cosines loses a factor of 1 / kSingularShare^2 of 1e-16.
TEST(Linkage, ForwardAndInverseUndoEachOther) {
  for (const Case& c : cases()) {
    Sampler sampler(c);
    for (int n = 0; n < kSamples; ++n) {
      const std::vector<double> q = sampler.joints();
      const LinkageState state = linkage_at(c.linkage, q.data());
      double back[kMaxAxes] = {};
      ASSERT_TRUE(linkage_to(c.linkage, state.pose, back)) << c.name;
      for (std::size_t i = 0; i < q.size(); ++i) ASSERT_NEAR(back[i], q[i], 1e-11) << c.name << " joint " << i;
      const LinkageState again = linkage_at(c.linkage, back);
      ASSERT_LT(norm(again.pose.position_m - state.pose.position_m), 1e-12) << c.name;
      ASSERT_LT(norm(turn_between(again.pose, state.pose)), 1e-11) << c.name;
    }
  }
}

void expect_at(const Linkage& linkage, std::vector<double> joint, Vec3 position_m) {
  const LinkageState state = linkage_at(linkage, joint.data());
  EXPECT_LT(norm(state.pose.position_m - position_m), 1e-15);
}

TEST(Linkage, PositionsByHand) {
  const double right = kPi / 2;
  const Linkage arm{LinkageKind::kSerial3r, false, 0.2, 0.15};
  expect_at(arm, {0, right, 0}, {0.15, 0, 0.2});         // upper arm up, forearm level
  expect_at(arm, {right, right, -right}, {0, 0, 0.05});  // forearm hangs beside it
  expect_at(arm, {right, 0, 0}, {0, 0.35, 0});           // stretched to the right
  const Linkage delta{LinkageKind::kDelta, false, 0.1, 0.2, 0.09, 0.03};
  // Arms in the plane of the motors: elbows on a circle of 0.16 m, forearms of 0.2 m meet 0.12 m above it.
  expect_at(delta, {0, 0, 0}, {0, 0, 0.12});
  const Linkage bars{LinkageKind::kFiveBar, false, 0.1, 0.13, 0.1};
  expect_at(bars, {right, right}, {0, 0.22, 0});  // elbows 0.1 m apart at 0.1 m: 0.05, 0.12, 0.13
}

// 3 N straight down on a stretched-out level forearm under an upright arm: all of it on the forearm's motor.
TEST(Linkage, TorquesByHand) {
  const Linkage arm{LinkageKind::kSerial3r, false, 0.2, 0.15};
  const double joint[] = {0, kPi / 2, 0};
  double torque[kMaxAxes];
  joint_torques(arm, linkage_at(arm, joint), {{0, 0, -3}, {}}, torque);
  EXPECT_NEAR(torque[0], 0, 1e-15);
  EXPECT_NEAR(torque[1], 0, 1e-15);
  EXPECT_NEAR(torque[2], -3 * 0.15, 1e-15);
}

void expect_no_torque(const Linkage& linkage, const LinkageState& state) {
  double torque[kMaxAxes] = {1, 1, 1, 1, 1, 1};
  joint_torques(linkage, state, {{5, 6, 7}, {1, 1, 1}}, torque);
  for (int i = 0; i < joint_count(linkage); ++i) EXPECT_EQ(torque[i], 0);
}

TEST(Linkage, ASingularPlaceKeepsItsPoseAndGetsNoTorque) {
  struct Singular {
    Linkage linkage;
    std::vector<double> joint;
  };
  const Linkage arm{LinkageKind::kSerial3r, true, 0.2, 0.15};
  const Linkage bars{LinkageKind::kFiveBar, false, 0.1, 0.06, 0.1};
  const Singular singular[] = {{arm, {0, 0.5, 0.45, 0, 0, 0}},                 // stretched: 0.05 rad between the links
                               {arm, {0, 2.2, 0.7, 0, 0, 0}},                  // over the post: r = -0.003 m
                               {arm, {0, 1, -0.5, 0, kPi / 2, 0}},             // gimbal lock
                               {bars, {kPi / 2 + 0.0998, kPi / 2 - 0.0998}}};  // elbows 0.1199 m apart of 0.12: in line
  for (const Singular& s : singular) {
    const LinkageState state = linkage_at(s.linkage, s.joint.data());
    EXPECT_EQ(state.place, LinkagePlace::kSingular);
    EXPECT_TRUE(is_finite(state.pose));
    expect_no_torque(s.linkage, state);
  }
}

// Wherever the joints are, numbers come out or the place says that none do.
TEST(Linkage, NoJointsGiveWhatIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  std::mt19937 random(11);
  std::uniform_real_distribution<> any(-kPi, kPi);
  for (const Case& c : cases()) {
    int place[3] = {};
    for (int n = 0; n < 20000; ++n) {
      double q[kMaxAxes];
      for (double& joint : q) joint = any(random);
      if (n % 10 == 0) q[n / 10 % joint_count(c.linkage)] = n % 20 == 0 ? nan : inf;
      const LinkageState state = linkage_at(c.linkage, q);
      place[static_cast<int>(state.place)] += 1;
      ASSERT_TRUE(is_finite(state.pose)) << c.name;
      double torque[kMaxAxes];
      joint_torques(c.linkage, state, {{5, 6, 7}, {1, 1, 1}}, torque);
      for (int i = 0; i < joint_count(c.linkage); ++i) ASSERT_TRUE(is_finite(torque[i])) << c.name;
      ASSERT_TRUE(n % 10 != 0 || state.place == LinkagePlace::kUnreachable) << c.name;
    }
    EXPECT_GT(place[0], 200) << c.name;
    EXPECT_TRUE(c.linkage.kind == LinkageKind::kCartesian || place[1] > 100) << c.name;
    EXPECT_GE(place[2], 2000) << c.name;
  }
  const Linkage delta = cases()[3].linkage;
  double joint[kMaxAxes] = {1, 2, 3};
  EXPECT_FALSE(linkage_to(delta, {{0.5, 0, 0.1}, {}}, joint));  // out of reach
  EXPECT_FALSE(linkage_to(delta, {{nan, 0, 0.1}, {}}, joint));
  EXPECT_EQ(joint[0], 1);
}

}  // namespace
}  // namespace palpate
