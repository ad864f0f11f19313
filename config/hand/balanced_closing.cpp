#include "config/hand/balanced_closing.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "config/bake/image_rules.h"
#include "config/bake/tick_memory.h"
#include "config/hand/cone_combination.h"
#include "config/hand/hand_model.h"
#include "rt_core/math.h"
#include "rt_core/tick.h"

namespace palpate {

namespace {

using Eigen::Index;
using Wrench6 = Eigen::Matrix<double, 6, 1>;

// A closing in as many ticks ends at the forces of one in the scene's time to 2e-4 of them (2026-11-25: contact depends
// on the way only by where regions first touch).
constexpr int kClosingTicks = 100, kStillTicks = 3;
constexpr int kRounds = 30, kHalvings = 10;
constexpr double kProbe_rad = 2e-4;         // of the slopes; as near to a limit is at it
constexpr double kLargestStep_rad = 0.03;   // a part of 27 mm moves by less than a millimetre
constexpr double kSmallestStep_rad = 1e-8;  // done
constexpr double kDamping_N_per_rad = 0.1;  // slopes are 10 and more: keeps still what has no effect
// Weights of a part's even share beside the whole finger's force: first both alike, so that no part leaves the body on
// the way; then little, so that where the joints' limits allow no even share the finger's force is off by the square of
// it, a thousandth.
constexpr double kEvenness[] = {1, 0.03};
constexpr int kThumbSteps = 20;
constexpr double kThumbStep_N = 0.3, kThumbSettled_N = 1e-5;
constexpr double kEffort = 0.1;  // what a newton of the thumb's counts beside one that is left for friction
constexpr int kPalmCorners = 8;
constexpr double kNearly = 1e-2;  // of a finger's force: further off than this is told

class Closer {
 public:
  Closer(const ImageContents& image, const HandDesc& hand)
      : hand_(hand), joint_(image.joint), model_(driven(image, joint_)), memory_(model_) {
    for (std::size_t p = 0; p < model_.piece.size(); ++p)
      if (model_.piece[p].joint >= 0) part_.push_back({p, static_cast<std::size_t>(model_.piece[p].joint)});
  }

  BalancedClosing run() {
    play();
    std::erase_if(part_, [this](const Part& part) { return !(piece_N(part.piece) > 0); });
    BalancedClosing result;
    for (const Part& part : part_)
      if (group_of(part.piece) == 0) thumb_N_.push_back(piece_N(part.piece));
    for (const double evenness : kEvenness) {
      evenness_ = evenness;
      for (int step = 0; step < kThumbSteps; ++step) {
        result.rounds += solve();
        if (oppose()) break;
      }
    }
    play();
    for (const Joint& joint : joint_) result.closed.push_back(joint.closed);
    for (std::int32_t f = 0; f < kMaxFingers; ++f) result.normal_N[static_cast<std::size_t>(f)] = finger_N(f);
    result.left_N = left_N();
    tell(result);
    return result;
  }

 private:
  struct Part {
    std::size_t piece, joint;
  };

  // Joints follow the closing at once and stop for no force: what is asked for is where they end.
  static Model driven(const ImageContents& image, std::vector<Joint>& joint) {
    Model model = model_of(image);
    for (Joint& j : joint) j.speed_max = 1e4;
    model.joint = joint;
    model.params.closing_rate_per_s = 1 / model.params.period_s;
    model.params.stop_force_N = 1e6;
    return model;
  }

  // Of the body, in the hand's frame at the grasp.
  static Vec3 centre_of(const Model& model) {
    const ModelParams& p = model.params;
    return inverse_transform(model.grasp_w[0], {p.body_centre_x_m, p.body_centre_y_m, p.body_centre_z_m});
  }

  // The hand at the grasp closes from open to the joints' closed positions.
  void play() {
    reset(memory_.state);
    Input input;
    input.drive = Drive::kTool;
    input.pose_w = model_.grasp_w[0];
    Output output;
    for (int i = 1; i <= kClosingTicks + kStillTicks; ++i) {
      const float closing = std::min(1.0F, static_cast<float>(i) / kClosingTicks);
      std::ranges::fill(input.joints.closing, closing);
      tick(model_, memory_.state, memory_.scratch, input, output);
    }
  }

  std::int32_t group_of(std::size_t piece) const { return model_.piece[piece].group; }
  std::size_t finger_of(const Part& part) const { return static_cast<std::size_t>(group_of(part.piece)); }
  double piece_N(std::size_t piece) const { return norm(memory_.state.articulation.piece_force_tool_N.data()[piece]); }
  double finger_N(std::int32_t finger) const {
    double sum = 0;
    for (std::size_t p = 0; p < model_.piece.size(); ++p)
      if (model_.piece[p].joint >= 0 && group_of(p) == finger) sum += piece_N(p);
    return sum;
  }

  Wrench6 wrench(Vec3 force, Vec3 moment) const {
    const double per_m = 2 / model_.params.surface_size_m;
    Wrench6 w;
    w << force.x, force.y, force.z, per_m * moment.x, per_m * moment.y, per_m * moment.z;
    return w;
  }

  // Of a piece's contacts on the body, about the body's centre, in the tool's frame.
  Wrench6 wrench_of(std::size_t piece) const {
    const ArticulationState& a = memory_.state.articulation;
    const Vec3 force = -a.piece_force_tool_N.data()[piece];
    return wrench(force, -a.piece_torque_tool_Nm.data()[piece] - cross(centre_tool_m_, force));
  }

  // The palm's push by a newton at corners of its face.
  Eigen::MatrixXd palm_pushes() const {
    const ModelParams& p = model_.params;
    const Vec3 out{0, 0, -1};
    Eigen::MatrixXd push(6, kPalmCorners);
    for (int k = 0; k < kPalmCorners; ++k) {
      const double angle = 2 * kPi * k / kPalmCorners;
      const Vec3 at = p.palm_radius_m * Vec3{math::cos(angle), math::sin(angle), 0} + p.palm_face_m * out;
      push.col(k) = wrench(out, cross(at - centre_tool_m_, out));
    }
    return push;
  }

  double left_N() const {
    Wrench6 sum = Wrench6::Zero();
    for (std::size_t p = 0; p < model_.piece.size(); ++p)
      if (model_.piece[p].joint >= 0) sum += wrench_of(p);
    return cone_combination(palm_pushes(), -sum).residual.norm();
  }

  // What the thumb's parts have to press with, in the order of part_: the forces above a least one that leave least of
  // the wrench of all, the palm pushing as it likes. What they press with counts a little itself.
  std::vector<double> opposing_N() const {
    std::vector<std::size_t> thumb;
    for (const Part& part : part_)
      if (group_of(part.piece) == 0) thumb.push_back(part.piece);
    const auto n = std::ssize(thumb);
    const double least_N = least_of_thumb_N();
    Eigen::MatrixXd push = Eigen::MatrixXd::Zero(6 + n, n + kPalmCorners);
    Eigen::VectorXd rest = Eigen::VectorXd::Zero(6 + n);
    push.topRightCorner(6, kPalmCorners) = palm_pushes();
    for (std::size_t p = 0; p < model_.piece.size(); ++p) {
      if (model_.piece[p].joint < 0) continue;
      const auto found = std::ranges::find(thumb, p) - thumb.begin();
      if (found == n) {
        rest.head(6) += wrench_of(p);
        continue;
      }
      push.col(found).head(6) = wrench_of(p) / piece_N(p);
      push(6 + found, found) = kEffort;
      rest += least_N * push.col(found);
    }
    const Eigen::VectorXd more = cone_combination(push, -rest).weight;
    std::vector<double> force_N;
    for (Index i = 0; i < n; ++i) force_N.push_back(least_N + more[i]);
    return force_N;
  }

  // Half of what the other fingers' parts press with on the mean: none of the thumb's is without load.
  double least_of_thumb_N() const {
    double sum = 0, parts = 0;
    for (std::int32_t f = 1; f < kMaxFingers; ++f)
      if (takes_part(hand_.fingers, f)) sum += hand_.grip_N[static_cast<std::size_t>(f)], parts += 3;
    return 0.5 * sum / parts;
  }

  // What is to be zero: what each finger lacks of its force, then, as far as the joints allow, what each part lacks of
  // an even share.
  Eigen::VectorXd misfit() {
    play();
    FingerNumbers target = hand_.grip_N, count{};
    target[0] = std::accumulate(thumb_N_.begin(), thumb_N_.end(), 0.0);
    for (const Part& part : part_) count[finger_of(part)] += 1;
    auto thumb = thumb_N_.begin();
    Eigen::VectorXd lack = Eigen::VectorXd::Zero(kMaxFingers + std::ssize(part_));
    Index row = kMaxFingers;
    for (const Part& part : part_) {
      const std::size_t f = finger_of(part);
      lack[static_cast<Index>(f)] = target[f] - finger_N(static_cast<std::int32_t>(f));
      lack[row++] = evenness_ * ((f == 0 ? *thumb++ : target[f] / count[f]) - piece_N(part.piece));
    }
    return lack;
  }

  bool all_press() const {
    return std::ranges::all_of(part_, [this](const Part& part) { return piece_N(part.piece) > 0; });
  }
  double& closed(std::size_t i) { return joint_[part_[i].joint].closed; }

  Eigen::MatrixXd slopes(const Eigen::VectorXd& lack) {
    Eigen::MatrixXd slope(lack.size(), std::ssize(part_));
    for (std::size_t i = 0; i < part_.size(); ++i) {
      const double before = closed(i);
      const double probe = before > joint_[part_[i].joint].lowest + kProbe_rad ? -kProbe_rad : kProbe_rad;
      closed(i) = before + probe;
      slope.col(static_cast<Index>(i)) = (misfit() - lack) / probe;
      closed(i) = before;
    }
    return slope;
  }

  // The step of least squares; joints that it would turn beyond a limit at which they stand keep still.
  Eigen::VectorXd step_of(Eigen::MatrixXd slope, const Eigen::VectorXd& lack) {
    Eigen::VectorXd step;
    for (std::size_t tries = 0; tries <= part_.size(); ++tries) {
      Eigen::MatrixXd damped(slope.rows() + slope.cols(), slope.cols());
      damped << slope, kDamping_N_per_rad * Eigen::MatrixXd::Identity(slope.cols(), slope.cols());
      Eigen::VectorXd goal = Eigen::VectorXd::Zero(damped.rows());
      goal.head(lack.size()) = -lack;
      step = damped.colPivHouseholderQr().solve(goal);
      bool all_can = true;
      for (std::size_t i = 0; i < part_.size(); ++i) {
        const Joint& joint = joint_[part_[i].joint];
        const auto k = static_cast<Index>(i);
        if (step[k] == 0 ||
            (step[k] > 0 ? joint.closed < joint.highest - kProbe_rad : joint.closed > joint.lowest + kProbe_rad))
          continue;
        slope.col(k).setZero();
        all_can = false;
      }
      if (all_can) break;
    }
    const double most = step.lpNorm<Eigen::Infinity>();
    if (most > kLargestStep_rad) step *= kLargestStep_rad / most;
    return step;
  }

  // Turns the joints by `share` of a step, within their limits.
  void turn(const std::vector<double>& from, const Eigen::VectorXd& step, double share) {
    for (std::size_t i = 0; i < part_.size(); ++i) {
      const Joint& joint = joint_[part_[i].joint];
      closed(i) = clamp_to(from[i] + share * step[static_cast<Index>(i)], joint.lowest, joint.highest);
    }
  }

  // Brings what the thumb is to press with nearer to what opposes the others; whether it was there.
  bool oppose() {
    play();
    const std::vector<double> goal = opposing_N();
    bool settled = true;
    for (std::size_t i = 0; i < goal.size(); ++i) {
      const double change = goal[i] - thumb_N_[i];
      thumb_N_[i] += std::clamp(change, -kThumbStep_N, kThumbStep_N);
      settled = settled && std::abs(change) < kThumbSettled_N;
    }
    return settled;
  }

  // Gauss and Newton's method.
  int solve() {
    if (part_.empty()) return 0;
    Eigen::VectorXd lack = misfit();
    for (int round = 0; round < kRounds; ++round) {
      const Eigen::VectorXd step = step_of(slopes(lack), lack);
      if (!(step.lpNorm<Eigen::Infinity>() > kSmallestStep_rad)) return round;
      std::vector<double> from;
      for (std::size_t i = 0; i < part_.size(); ++i) from.push_back(closed(i));
      const double before = lack.norm();
      bool nearer = false;
      double share = 1;
      for (int k = 0; k < kHalvings && !nearer; ++k, share *= 0.5) {
        turn(from, step, share);
        lack = misfit();
        nearer = lack.norm() < before && all_press();
      }
      if (nearer) continue;
      turn(from, step, 0);
      return round;
    }
    return kRounds;
  }

  void tell(BalancedClosing& result) const {
    std::string missing, off;
    const double thumb_N = std::accumulate(thumb_N_.begin(), thumb_N_.end(), 0.0);
    for (std::int32_t f = 0; f < kMaxFingers; ++f) {
      if (!takes_part(hand_.fingers, f)) continue;
      const double is_N = finger_N(f), asked_N = f == 0 ? thumb_N : hand_.grip_N[static_cast<std::size_t>(f)];
      if (!(is_N > 0)) {
        missing += (missing.empty() ? "" : ", ") + std::string(finger_name(f));
      } else if (!(std::abs(is_N - asked_N) < kNearly * asked_N)) {
        off += (off.empty() ? "" : ", ") + std::string(finger_name(f)) + " " + std::to_string(is_N) + " N of " +
               std::to_string(asked_N) + " N";
      }
    }
    if (!missing.empty()) result.warning = "fingers that meet nothing and press with no force: " + missing;
    if (off.empty()) return;
    result.warning += (result.warning.empty() ? "" : "; ") + ("hand.grip_N is not reached: " + off) +
                      "; ask for less, or move hand.grasp_mm so that the joints reach";
  }

  const HandDesc& hand_;
  std::vector<Joint> joint_;
  Model model_;
  TickMemory memory_;
  Vec3 centre_tool_m_ = centre_of(model_);
  std::vector<Part> part_;       // that press
  std::vector<double> thumb_N_;  // what each of its parts is to press with
  double evenness_ = 1;
};

}  // namespace

BalancedClosing close_balanced(const ImageContents& image, const HandDesc& hand) { return Closer(image, hand).run(); }

}  // namespace palpate
