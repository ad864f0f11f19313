// The skeleton as one elastic frame: how far the anchors really move.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "config/beams/beam_rows.h"

namespace palpate {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Clamped at every anchor, a skeleton can tell the stress there but not the displacement: next to the contact an anchor
// takes nearly all of the force, and the far side never hears of it. Here the anchors are joints: beams join them to
// one another, only the fixed ones are held, and the load travels on through the body to them. Linear, solved once per
// surface vertex when a scene is baked; at run time a 3x3 matrix per anchor, as before.
class BeamFrame {
 public:
  // `joint_m`: the anchors; `fixed`: which are held.
  BeamFrame(std::vector<Vec3> joint_m, std::vector<char> fixed);
  // Beams (one, or two ways with weights) whose tip belongs to joint `tip` and whose anchored end to joint `anchor`.
  void add(std::int32_t tip, std::int32_t anchor, const BeamChoice& choice, const BeamBuild& build);
  // To be called once, after the last add(). Joints that no chain of beams connects to a fixed one are left out.
  void assemble();
  bool is_grounded(std::int32_t joint) const { return grounded_[static_cast<std::size_t>(joint)] != 0; }
  // Displacement of every joint per force at the tip of `choice[joint]`, a contact's beams to all joints. Zero where
  // the contact reaches no grounded joint.
  std::vector<Eigen::Matrix3d> response(Vec3 tip_m, const BeamChoice* choice, const BeamBuild& build) const;
  double total_length_m() const { return length_m_; }

 private:
  struct Member {
    std::int32_t tip, anchor;
    Vec3 tip_m;
    Matrix6 stiffness;
  };
  void scatter(const Member& member, Eigen::MatrixXd& k) const;
  // First of the joint's six unknowns, or -1.
  std::int32_t unknown(std::int32_t joint) const { return unknown_[static_cast<std::size_t>(joint)]; }

  std::vector<Vec3> joint_m_;
  std::vector<char> fixed_, grounded_;
  std::vector<std::int32_t> unknown_;
  std::vector<Member> member_;
  Eigen::MatrixXd stiffness_;  // of the free grounded joints
  std::int32_t unknowns_ = 0;
  double length_m_ = 0;
};

}  // namespace palpate
