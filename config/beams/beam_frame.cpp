#include "config/beams/beam_frame.h"

#include <Eigen/Dense>

namespace palpate {

namespace {

Eigen::Matrix3d cross_of(Vec3 a) {
  Eigen::Matrix3d m;
  m << 0, -a.z, a.y, a.z, 0, -a.x, -a.y, a.x, 0;
  return m;
}

// Motion (translation, rotation) at `to` of a body that moves at `from`.
Matrix6 transport(Vec3 from, Vec3 to) {
  Matrix6 t = Matrix6::Identity();
  t.topRightCorner<3, 3>() = -cross_of(to - from);
  return t;
}

// Tip stiffness with the anchored end clamped.
Matrix6 tip_stiffness(const BeamChoice& choice, const BeamBuild& build) {
  Matrix6 sum = Matrix6::Zero();
  for (int way = 0; way < choice.count; ++way) {
    const Matrix6 k = curve_compliance6(choice.curve[way], build).inverse();
    sum += (0.5 * choice.weight[way]) * (k + k.transpose());
  }
  return sum;
}

bool is_beam(const BeamChoice& choice) { return choice.count > 0 && choice.curve[0].path != BeamPath::kPoint; }

}  // namespace

BeamFrame::BeamFrame(std::vector<Vec3> joint_m, std::vector<char> fixed)
    : joint_m_(std::move(joint_m)), fixed_(std::move(fixed)) {}

void BeamFrame::add(std::int32_t tip, std::int32_t anchor, const BeamChoice& choice, const BeamBuild& build) {
  if (!is_beam(choice)) return;
  member_.push_back({tip, anchor, choice.curve[0].tip_m, tip_stiffness(choice, build)});
  length_m_ += choice.curve[0].length_m;
}

void BeamFrame::assemble() {
  grounded_ = fixed_;
  for (std::size_t pass = 0; pass < joint_m_.size(); ++pass)
    for (const Member& m : member_) {
      char& tip = grounded_[static_cast<std::size_t>(m.tip)];
      char& anchor = grounded_[static_cast<std::size_t>(m.anchor)];
      tip = anchor = tip != 0 || anchor != 0 ? 1 : 0;
    }
  unknown_.assign(joint_m_.size(), -1);
  for (std::size_t j = 0; j < joint_m_.size(); ++j)
    if (grounded_[j] != 0 && fixed_[j] == 0) {
      unknown_[j] = unknowns_;
      unknowns_ += 6;
    }
  stiffness_ = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
  for (const Member& m : member_) scatter(m, stiffness_);
}

// Energy 1/2 (P q_tip - A q_anchor)^T K (P q_tip - A q_anchor), the motions carried to the member's tip.
void BeamFrame::scatter(const Member& m, Eigen::MatrixXd& k) const {
  const Matrix6 p = transport(joint_m_[static_cast<std::size_t>(m.tip)], m.tip_m);
  const Matrix6 a = transport(joint_m_[static_cast<std::size_t>(m.anchor)], m.tip_m);
  const std::int32_t i = unknown(m.tip), j = unknown(m.anchor);
  if (i >= 0) k.block<6, 6>(i, i) += p.transpose() * m.stiffness * p;
  if (j >= 0) k.block<6, 6>(j, j) += a.transpose() * m.stiffness * a;
  if (i < 0 || j < 0) return;
  const Matrix6 cross = -p.transpose() * m.stiffness * a;
  k.block<6, 6>(i, j) += cross;
  k.block<6, 6>(j, i) += cross.transpose();
}

std::vector<Eigen::Matrix3d> BeamFrame::response(Vec3 tip_m, const BeamChoice* choice, const BeamBuild& build) const {
  const std::size_t joints = joint_m_.size();
  std::vector<Eigen::Matrix3d> result(joints, Eigen::Matrix3d::Zero());
  const auto n = static_cast<Eigen::Index>(unknowns_);
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n + 6, n + 6);
  k.topLeftCorner(n, n) = stiffness_;
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(n + 6, 3);
  bool held = false;
  for (std::size_t j = 0; j < joints; ++j) {
    if (choice[j].count == 0 || grounded_[j] == 0) continue;
    const std::int32_t at = unknown_[j];
    if (!is_beam(choice[j])) {  // the contact is at the joint: load it there
      if (at < 0) return result;
      load.setZero();
      load.block<3, 3>(at, 0).setIdentity();
      k.bottomRightCorner<6, 6>() = Matrix6::Identity() * k.topLeftCorner(n, n).diagonal().maxCoeff();
      k.rightCols<6>().topRows(n).setZero();
      k.bottomRows<6>().leftCols(n).setZero();
      k.topLeftCorner(n, n) = stiffness_;
      held = true;
      break;
    }
    const Matrix6 s = tip_stiffness(choice[j], build);
    const Matrix6 a = transport(joint_m_[j], tip_m);
    k.bottomRightCorner<6, 6>() += s;
    if (at >= 0) {
      k.block<6, 6>(at, at) += a.transpose() * s * a;
      k.block<6, 6>(n, at) -= s * a;
      k.block<6, 6>(at, n) -= a.transpose() * s;
    }
    load.block<3, 3>(n, 0).setIdentity();
    held = true;
  }
  if (!held) return result;
  const Eigen::MatrixXd motion = k.ldlt().solve(load);
  for (std::size_t j = 0; j < joints; ++j)
    if (unknown_[j] >= 0) result[j] = motion.block<3, 3>(unknown_[j], 0);
  return result;
}

}  // namespace palpate
