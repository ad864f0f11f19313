#include "rt_core/tool/landing.h"

#include "rt_core/cholesky.h"
#include "rt_core/surface/body_box.h"
#include "rt_core/tool/two_tools.h"
#include "rt_core/tool/virtual_coupling.h"
#include "rt_core/unwritten.h"

namespace palpate {

namespace {

constexpr std::integral_constant<std::int32_t, 6> kDof;  // loops over it are unrolled

// What holds the tool at a part that it comes to is no softer than the place there, or it would be pressed in by more
// than what it came with: with 237 kN/m the arms that a tube has snapped through pressed it 16 um into a seat of 7
// kN/mm, and the model said 110 N (2026-11-26). Nor much stiffer: what slides over a round end goes off from the plane
// there, by 8 nm a tick, and a tool that was held by 1e8 N/m stood off for as long as it slid, ten ticks and 0.6 N that
// no contact knew of (2026-11-29). So much of E* and the length that it lies on: that seat's 10 mm are as stiff as it
// is.
constexpr Real kOfModulus = 0.35;
// Less is no landing.
constexpr Real kLeast_m = 1e-12;

// An end of what a tool point has below it on a part.
struct End {
  Vec3 n, turn;
  Real gap_m, gives_m_per_N;
  Real along(const Twist& t) const PALPATE_RT { return dot(n, t.translation_m) + dot(turn, t.rotation_rad); }
};

struct Held {
  const End* end;
  Twist per_N;  // motion of the tool by a newton there
  Real over_m;  // how deep it would go unheld
  Real force_N;
};

class Landing {
 public:
  Landing(const Model& model, const State& state, const Pose& from) PALPATE_RT
      : model_(model),
        state_(state),
        gone_(twist_between(state.tool_w, from)),
        gives_m2_per_N_((1 - model.params.poisson_ratio * model.params.poisson_ratio) /
                        (kOfModulus * model.params.youngs_modulus_Pa)) {
    const auto points = static_cast<std::int32_t>(model_.tool_point.size());
    for (std::int32_t i = 0; i < points && i < kMaxPieces; ++i) find_ends(i);  // bound: kMaxPieces
  }

  // By an active set (Lawson & Hanson 1974, chapter 23): the deepest end is held next, and what would have to pull is
  // let go. Taken in turn, the forces of two ends of one seat had not found each other after twelve turns.
  // Returns how many it took hold of.
  std::int32_t turn_aside(const Real* factor, Twist& motion) PALPATE_RT {
    const Twist wanted = motion;
    for (std::int32_t i = 0; i < kLandings; ++i) {  // bound: kLandings
      const End* deepest = deepest_of(motion);
      if (deepest == nullptr) return i;
      hold(*deepest, factor, wanted);
      share_out();
      motion = wanted;
      for (std::int32_t k = 0; k < held_; ++k) {  // bound: kLandings
        motion.translation_m += hold_[k].force_N * hold_[k].per_N.translation_m;
        motion.rotation_rad += hold_[k].force_N * hold_[k].per_N.rotation_rad;
      }
    }
    return kLandings;
  }

  void add_held(ContactStiffness& sum) const PALPATE_RT {
    for (std::int32_t k = 0; k < held_; ++k)  // bound: kLandings
      add_spring(sum, 1.0 / hold_[k].end->gives_m_per_N, hold_[k].end->n, hold_[k].end->turn);
  }

 private:
  void find_ends(std::int32_t i) PALPATE_RT {
    const ToolPoint& tool_point = model_.tool_point[static_cast<std::size_t>(i)];
    const PointState& point = state_.point[i];
    if (tool_point.begins_at == 0 || point.triangle < 0) return;
    const bool pressed = presses(point);
    const Real gap = point.gap_m >= 0 ? point.gap_m : point.gap_bound_m;
    if (!(gap < kHuge)) return;
    const ToolPiece& piece = model_.piece[static_cast<std::size_t>(tool_point.piece)];
    if (piece.shape == PieceShape::kCapsule)
      add_line(piece, point, gap, pressed);
    else if (!pressed)
      add(point.closest_w, point.normal_w, gap, piece.margin_m);
  }
  // A place that was touched and has no force is come to as well.
  bool presses(const PointState& point) const PALPATE_RT {
    return point.gap_m < 0 && point.region >= 0 && state_.region[point.region].normal_force_N > 0;
  }
  // A capsule comes down on either end of what it has below it, as far as the body goes on.
  void add_line(const ToolPiece& piece, const PointState& point, Real gap_m, bool pressed) PALPATE_RT {
    if (line_of_ != &piece) {  // once for all parts
      line_of_ = &piece;
      axis_w_ = rotate(state_.tool_w.orientation, rotate(piece.pose_tool.orientation, Vec3{0, 0, 1}));
      middle_w_ = transform(state_.tool_w, piece.pose_tool.position_m);
      box_ = root_box(model_);
    }
    const Vec3 axis = axis_w_;
    const Real half = piece.half_extent_m[2], at = dot(point.closest_w - middle_w_, axis),
               slope = dot(axis, point.normal_w);
    const Box& box = box_;
    Real from = min_of(-half - at, 0.0), to = max_of(half - at, 0.0);
    limit(axis.x, point.closest_w.x, box.lower.x, box.upper.x, from, to);
    limit(axis.y, point.closest_w.y, box.lower.y, box.upper.y, from, to);
    limit(axis.z, point.closest_w.z, box.lower.z, box.upper.z, from, to);
    for (const Real way : {from, to})  // of a line that leans on one end the other
      if (!pressed || gap_m + way * slope > 0) {
        const Real length = max_of(to - from, piece.margin_m);
        add(point.closest_w + way * axis, point.normal_w, gap_m + way * slope, length);
      }
  }
  static void limit(Real axis, Real at_m, Real lower_m, Real upper_m, Real& from, Real& to) PALPATE_RT {
    if (!(abs_of(axis) > 1e-3)) return;
    const Real inverse = 1.0 / axis, up = max_of(upper_m - at_m, 0.0) * inverse,
               down = min_of(lower_m - at_m, 0.0) * inverse;
    to = min_of(to, max_of(up, down));
    from = max_of(from, min_of(up, down));
  }
  void add(Vec3 place_w, Vec3 n, Real gap_m, Real length_m) PALPATE_RT {
    End& end = end_[ends_];
    end = {n, cross(place_w - state_.tool_w.position_m, n), 0, gives_m2_per_N_ / length_m};
    end.gap_m = max_of(gap_m + end.along(gone_), 0.0);
    ends_ += 1;
  }

  const End* deepest_of(const Twist& motion) const PALPATE_RT {
    const End* deepest = nullptr;
    Real most_m = kLeast_m;
    for (std::int32_t i = 0; i < ends_; ++i) {  // bound: 2 kMaxPieces
      const Real over_m = -end_[i].along(motion) - end_[i].gap_m;
      if (!(over_m > most_m) || is_held(end_[i])) continue;
      most_m = over_m;
      deepest = &end_[i];
    }
    return deepest;
  }
  bool is_held(const End& end) const PALPATE_RT {
    for (std::int32_t k = 0; k < held_; ++k)  // bound: kLandings
      if (hold_[k].end == &end) return true;
    return false;
  }
  void hold(const End& end, const Real* factor, const Twist& wanted) PALPATE_RT {
    Real x[kDof] = {end.n.x, end.n.y, end.n.z, end.turn.x, end.turn.y, end.turn.z};
    cholesky_solve(factor, x, kDof);
    hold_[held_] = {&end, {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}}, -end.along(wanted) - end.gap_m, 0};
    held_ += 1;
  }
  // Forces of the held ends, none of which pulls.
  void share_out() PALPATE_RT {
    for (std::int32_t i = 0; i < kLandings && held_ > 0; ++i) {  // bound: kLandings
      Real force_N[kLandings];
      if (!solve(force_N)) return let_go(held_ - 1);
      Real share = 1;
      std::int32_t first = -1;
      for (std::int32_t k = 0; k < held_; ++k) {  // bound: kLandings
        if (force_N[k] > 0) continue;
        const Real until = hold_[k].force_N / (hold_[k].force_N - force_N[k]);
        if (first >= 0 && !(until < share)) continue;
        share = first >= 0 || until < 1 ? until : 1;
        first = k;
      }
      for (std::int32_t k = 0; k < held_; ++k) hold_[k].force_N += share * (force_N[k] - hold_[k].force_N);
      if (first < 0) return;
      let_go(first);
    }
  }
  void let_go(std::int32_t k) PALPATE_RT {
    for (; k + 1 < held_; ++k) hold_[k] = hold_[k + 1];  // bound: kLandings
    held_ -= 1;
  }
  bool solve(Real* force_N) const PALPATE_RT {
    Real matrix[kLandings * kLandings];
    for (std::int32_t i = 0; i < held_; ++i) {  // bound: kLandings^2
      for (std::int32_t j = 0; j <= i; ++j) matrix[i * held_ + j] = hold_[i].end->along(hold_[j].per_N);
      matrix[i * held_ + i] += hold_[i].end->gives_m_per_N;
      force_N[i] = hold_[i].over_m;
    }
    if (!cholesky_factor(matrix, held_)) return false;
    cholesky_solve(matrix, force_N, held_);
    return true;
  }

  const Model& model_;
  const State& state_;
  const Twist gone_;
  const Real gives_m2_per_N_;
  const ToolPiece* line_of_ = nullptr;
  Vec3 axis_w_, middle_w_;              // of that piece
  Box box_{};                           // of the body
  Unwritten<End, 2 * kMaxPieces> end_;  // to clear them took 1,300 instructions a tick of snap_in (2026-11-27)
  Held hold_[kLandings];
  std::int32_t ends_ = 0, held_ = 0;
};

}  // namespace

std::int32_t land(const Model& model, const State& state, const Pose& from, const Real* factor, Twist& motion,
                  ContactStiffness* held) PALPATE_RT {
  Landing landing(model, state, from);
  const std::int32_t taken = landing.turn_aside(factor, motion);
  if (held != nullptr) landing.add_held(*held);
  return taken;
}

}  // namespace palpate
