#include "sim_host/doctor/move_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "hal/device/hand_path.h"
#include "hal/drives/axis_map.h"

namespace palpate {

namespace {

constexpr int kArmJoints = 3;  // a gimbal's come after them
constexpr double kMostAngle_deg = 35, kLeastMoved = 0.6, kMostMoved = 1.6;
constexpr double kDead_m = 0.002;  // of a lever's end, while the handle went 50 mm

std::string axis_text(const ArmProfile& arm, int axis) {
  return fmt::format("axis {} (node {:.0f})", axis + 1, arm.axes[static_cast<std::size_t>(axis)].node);
}

// What might be wrong with the three axes of an arm, or of a gimbal: drive i counts what axis `reads[i]` turns, times
// `scale[i]`.
struct Wiring {
  int reads[3] = {0, 1, 2};
  double scale[3] = {1, 1, 1};
};

class Judge {
 public:
  Judge(const ArmProfile& arm, const CartesianKinematics& frame, const std::vector<HandMove>& moves, bool gimbal)
      : arm_(arm), frame_(frame), first_(gimbal ? kArmJoints : 0) {
    count_ = gimbal ? 3 : arm_joint_count(arm.linkage);
    for (const HandMove& move : moves)
      if (move.of_gimbal == gimbal) moves_.push_back(&move);
  }
  bool empty() const { return moves_.empty(); }
  bool gimbal() const { return first_ > 0; }

  // What the move was, in parts of what was asked, if the drives were wired so; nothing where no handle fits.
  std::optional<Vec3> seen(const HandMove& move, const Wiring& wiring) const {
    double from[kMaxAxes], to[kMaxAxes];
    undo(move.from, wiring, from);
    undo(move.to, wiring, to);
    if (gimbal()) return (1 / kAskedTurn_rad) * Vec3{to[3] - from[3], to[4] - from[4], to[5] - from[5]};
    const LinkageState before = linkage_at(arm_.linkage, from), after = linkage_at(arm_.linkage, to);
    if (before.place == LinkagePlace::kUnreachable || after.place == LinkagePlace::kUnreachable) return std::nullopt;
    return (1 / kAskedMove_m) * rotate(frame_.orientation_w, after.pose.position_m - before.pose.position_m);
  }
  static bool fits(const Vec3& seen, const Vec3& asked) {
    const double share = dot(seen, asked), cosine = share / std::max(norm(seen), 1e-12);
    return cosine >= std::cos(kMostAngle_deg * kPi / 180) && share >= kLeastMoved && share <= kMostMoved;
  }
  bool all_fit(const Wiring& wiring, const Quat& turned = {}, double scale = 1) const {
    return std::ranges::all_of(moves_, [&](const HandMove* move) {
      const std::optional<Vec3> way = seen(*move, wiring);
      return way && fits(scale * rotate(turned, *way), move->along);
    });
  }
  // Mean square of what the wiring leaves unexplained.
  double left(const Wiring& wiring, const Quat& turned = {}) const {
    double sum = 0;
    for (const HandMove* move : moves_) {
      const std::optional<Vec3> way = seen(*move, wiring);
      sum += way ? squared_norm(rotate(turned, *way) - move->along) : std::numeric_limits<double>::infinity();
    }
    return sum / static_cast<double>(moves_.size());
  }
  std::string dead_axes() const;
  std::string explanation() const;

 private:
  void undo(const double* told, const Wiring& wiring, double* joint) const {
    for (int i = 0; i < joint_count(arm_.linkage); ++i) joint[i] = told[i];
    for (int i = 0; i < count_; ++i) {
      const int axis = first_ + wiring.reads[i], drive = first_ + i;  // the drive told what that axis did
      const AxisProfile& of_drive = arm_.axes[static_cast<std::size_t>(drive)];
      const AxisProfile& of_axis = arm_.axes[static_cast<std::size_t>(axis)];
      const double turns = (told[drive] - of_drive.home_joint) / joint_per_turn(of_drive) / wiring.scale[i];
      joint[axis] = of_axis.home_joint + turns * joint_per_turn(of_axis);
    }
  }
  // Mistakes of one kind, each with its words; the best of those that explain every move.
  struct Mistake {
    Wiring wiring;
    std::string words;
    Quat turned = {};
  };
  std::string best(const std::vector<Mistake>& mistakes) const;
  std::vector<Mistake> single() const;
  std::vector<Mistake> doubled() const;
  std::vector<Mistake> turned_frames() const;
  std::string other_length() const;
  std::string name(int i) const { return axis_text(arm_, first_ + i); }

  const ArmProfile& arm_;
  const CartesianKinematics& frame_;
  int first_, count_;
  std::vector<const HandMove*> moves_;
};

// Those that stood still in all moves, of which each moves one at least.
std::string Judge::dead_axes() const {
  std::string dead;
  for (int i = first_; i < first_ + count_; ++i) {
    double most = 0;
    for (const HandMove* move : moves_) most = std::max(most, std::abs(move->to[i] - move->from[i]));
    if (most * lever_m(arm_, i) < kDead_m) dead += (dead.empty() ? "" : ", ") + axis_text(arm_, i);
  }
  return dead;
}

std::string Judge::best(const std::vector<Mistake>& mistakes) const {
  double least = std::numeric_limits<double>::infinity();
  std::string words;
  for (const Mistake& mistake : mistakes) {
    const double rest = left(mistake.wiring, mistake.turned);
    if (!(rest < least) || !all_fit(mistake.wiring, mistake.turned)) continue;
    least = rest;
    words = mistake.words;
  }
  return words;
}

std::vector<Judge::Mistake> Judge::single() const {
  std::vector<Mistake> all;
  for (int i = 0; i < count_; ++i) {
    Mistake reversed{{}, name(i) + " is reversed: its direction, or its encoder's leads"};
    reversed.wiring.scale[i] = -1;
    all.push_back(reversed);
    for (const double scale : {0.25, 0.5, 2.0, 4.0}) {  // edges for counts, gear ratios
      Mistake scaled{
          {}, fmt::format("{} counts some {} times too much: counts_per_turn, ratio or mm_per_turn", name(i), scale)};
      scaled.wiring.scale[i] = scale;
      all.push_back(scaled);
    }
    for (int k = 0; k < i; ++k) {
      Mistake swapped{{}, name(k) + " and " + name(i) + " are swapped: their encoders, or their nodes"};
      std::swap(swapped.wiring.reads[k], swapped.wiring.reads[i]);
      all.push_back(swapped);
    }
  }
  return all;
}

// Every order and every sign: more than one mistake at once.
std::vector<Judge::Mistake> Judge::doubled() const {
  std::vector<Mistake> all;
  int order[3] = {0, 1, 2};
  do {
    for (int signs = 0; signs < 1 << count_; ++signs) {
      Mistake mistake;
      for (int i = 0; i < count_; ++i) {
        mistake.wiring.reads[i] = order[i];
        mistake.wiring.scale[i] = (signs >> i & 1) != 0 ? -1 : 1;
        if (order[i] == i && mistake.wiring.scale[i] > 0) continue;
        mistake.words += (mistake.words.empty() ? "" : "; ") + name(i);
        if (order[i] != i) mistake.words += " counts what " + name(order[i]) + " turns";
        if (mistake.wiring.scale[i] < 0) mistake.words += order[i] != i ? ", reversed" : " is reversed";
      }
      all.push_back(mistake);
    }
  } while (std::next_permutation(order, order + count_));
  return all;
}

// The quarter turns of a cube.
std::vector<Judge::Mistake> Judge::turned_frames() const {
  const auto turn = [](const Vec3& about, int quarters) { return rotation_by(0.5 * kPi * quarters * about); };
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  std::vector<Mistake> all;
  for (const Quat& tilt : {Quat{}, turn(x, 1), turn(x, 2), turn(x, 3), turn(z, 1), turn(z, 3)})
    for (int quarters = 0; quarters < 4; ++quarters)
      all.push_back({{},
                     "the device stands turned: forward (x+), up (y+) and right (z+) of the scene are not the hand's: "
                     "turn_x_deg, turn_y_deg, turn_z_deg of [frame]",
                     turn(y, quarters) * tilt});
  return all;
}

// Right in direction and all by the same factor.
std::string Judge::other_length() const {
  double sum = 0;
  for (const HandMove* move : moves_) sum += dot(seen(*move, {}).value_or(Vec3{}), move->along);
  const double share = sum / static_cast<double>(moves_.size());
  if (!(share > 0.05) || !all_fit({}, {}, 1 / share)) return "";
  return fmt::format(
      "everything moves {:.2g} times as far as was asked: counts_per_turn, ratio, mm_per_turn or lengths "
      "of all axes, or the hand went another way than asked",
      share);
}

std::string Judge::explanation() const {
  if (std::string dead = dead_axes(); !dead.empty())
    return dead + " did not count: encoder, its cable, or the profile's node";
  std::string words = best(single());
  if (words.empty()) words = other_length();
  if (words.empty() && !gimbal()) words = best(turned_frames());
  const bool slides = arm_.linkage.kind == LinkageKind::kCartesian;  // two of these look like a turned frame
  if (const std::string two = words.empty() || slides ? best(doubled()) : ""; !two.empty())
    words += (words.empty() ? "" : "; or ") + two;
  return words.empty() ? "no mistake of one or two axes explains this: lengths, home, or another way than was asked"
                       : words;
}

std::string way_text(const Vec3& way, bool gimbal) {
  const double unit = gimbal ? kAskedTurn_rad * 180 / kPi : 1e3 * kAskedMove_m;
  const char* format = gimbal ? "joints turned by ({:.0f}, {:.0f}, {:.0f}) degrees"
                              : "the handle went ({:.0f}, {:.0f}, {:.0f}) mm in the world";
  return fmt::format(fmt::runtime(format), unit * way.x, unit * way.y, unit * way.z);
}

}  // namespace

double lever_m(const ArmProfile& arm, int axis) {
  if (arm.linkage.kind == LinkageKind::kCartesian) return 1;
  return axis < kArmJoints ? arm.linkage.upper_m : kAskedMove_m / kAskedTurn_rad;
}

std::vector<HandMove> asked_moves(const ArmProfile& arm, const CartesianKinematics& frame) {
  std::vector<HandMove> moves;
  for (const auto& [word, along] :
       {std::pair{"forward (x+)", Vec3{1, 0, 0}}, {"up (y+)", {0, 1, 0}}, {"to the right (z+)", {0, 0, 1}}}) {
    const bool flat = arm.linkage.kind == LinkageKind::kFiveBar;  // moves in its own plane
    if (flat && std::abs(rotate(conjugate(frame.orientation_w), along).z) > 0.5) continue;
    moves.push_back({word, along});
  }
  if (!arm.linkage.gimbal) return moves;
  moves.push_back({"about the upright axis across the forearm, anticlockwise seen from above", {1, 0, 0}, true});
  moves.push_back({"about the level axis across the forearm, so that its far end sinks", {0, 1, 0}, true});
  moves.push_back({"about the forearm's own line, clockwise as seen along it outwards", {0, 0, 1}, true});
  return moves;
}

std::vector<DoctorItem> judge_moves(const ArmProfile& arm, const CartesianKinematics& frame,
                                    const std::vector<HandMove>& moves) {
  std::vector<DoctorItem> rows;
  for (const bool gimbal : {false, true}) {
    const Judge judge(arm, frame, moves, gimbal);
    if (judge.empty()) continue;
    for (const HandMove& move : moves) {
      if (move.of_gimbal != gimbal) continue;
      const std::optional<Vec3> seen = judge.seen(move, {});
      const bool good = seen && Judge::fits(*seen, move.along);
      rows.push_back({move.word, good ? Verdict::kPass : Verdict::kFail,
                      seen ? way_text(*seen, gimbal) : "joints that fit no handle", ""});
    }
    const bool right = judge.all_fit({}) && judge.dead_axes().empty();
    rows.push_back({gimbal ? "axes of the gimbal" : "axes", right ? Verdict::kPass : Verdict::kFail,
                    right ? "signs, order and scale are the profile's" : judge.explanation(), ""});
  }
  return rows;
}

MoveCheck::MoveCheck(AxisDevice& device, const ArmProfile& arm, const CartesianKinematics& frame,
                     AxisDrives::Pause pause, Tell tell)
    : device_(device), arm_(arm), frame_(frame), pause_(std::move(pause)), tell_(std::move(tell)) {}

// A millisecond with motors off; whether positions came.
bool MoveCheck::step() {
  DeviceSample sample;
  pause_();
  device_.transmit({});
  device_.receive(sample);
  return sample.fresh;
}

double MoveCheck::moved_m(const double* from) const {
  double most = 0;
  for (int i = 0; i < joint_count(arm_.linkage); ++i)
    most = std::max(most, std::abs(device_.joint(i) - from[i]) * lever_m(arm_, i));
  return most;
}

// Until the handle, which must have moved first, lies still for a second. "" or why it never did.
std::string MoveCheck::await_rest(bool moved) {
  constexpr int kMost_ms = 30'000, kStill_ms = 1000, kSilent_ms = 500;
  constexpr double kMoved_m = 0.008, kStill_m = 0.0015;  // a hand's tremor is below a millimetre
  double still_at[kMaxAxes] = {};
  int still_ms = 0, silent_ms = 0;
  for (int ms = 0; ms < kMost_ms; ++ms) {
    silent_ms = step() ? 0 : silent_ms + 1;
    if (silent_ms > kSilent_ms) return "the drives send no positions any more";
    if (moved && moved_m(rest_) < kMoved_m) continue;
    still_ms = ms > 0 && moved_m(still_at) < kStill_m ? still_ms + 1 : 0;
    if (still_ms == 0)
      for (int i = 0; i < kMaxAxes; ++i) still_at[i] = device_.joint(i);
    if (still_ms < kStill_ms) continue;
    for (int i = 0; i < kMaxAxes; ++i) rest_[i] = device_.joint(i);
    return "";
  }
  return moved ? "no axis counted a motion in 30 s: encoders, cables, or nobody moved the handle"
               : "the handle did not lie still in 30 s";
}

std::vector<DoctorItem> MoveCheck::run() {
  std::vector<HandMove> moves = asked_moves(arm_, frame_);
  tell_("Hold the handle still, in the middle of its reach. No motor is enabled.");
  std::string wrong = await_rest(false);
  for (std::size_t i = 0; i < moves.size() && wrong.empty(); ++i) {
    HandMove& move = moves[i];
    std::ranges::copy(rest_, move.from);
    tell_(fmt::format("{} of {}: {} the handle {} by {}, and hold it still there.", i + 1, moves.size(),
                      move.of_gimbal ? "turn" : "move", move.word,
                      move.of_gimbal ? "45 degrees" : "50 mm (lay a ruler beside it)"));
    wrong = await_rest(true);
    if (!wrong.empty()) break;
    std::ranges::copy(rest_, move.to);
    if (i + 1 == moves.size()) break;
    tell_("Seen. Back to the middle, and hold it still.");
    wrong = await_rest(true);
  }
  tell_(wrong.empty() ? "Seen." : "Ended: " + wrong);
  if (!wrong.empty()) return {{"moved by hand", Verdict::kFail, wrong, ""}};
  return judge_moves(arm_, frame_, moves);
}

}  // namespace palpate
