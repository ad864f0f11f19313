#include "rt_core/contact/nodes/nodes.h"

#include <bit>

namespace palpate {

namespace {

// Penetration of a node left out above which the tick says so, beyond what the tool moved in it, which the body has not
// followed yet: a thirtieth of an encoder's step, and far above the rounding of a surface on which all nodes touch
// alike.
constexpr Real kTolerance_m = 1e-6;

// One of the near nodes.
struct Lane {
  std::int16_t four;
  std::int16_t k;
};

// How many may join when so many pushed.
std::int32_t places_for(std::int32_t pushed) PALPATE_RT {
  if (pushed == 0) return kMaxContacts;
  std::int32_t problem = whole_lanes(pushed + kMinJoining, 8);
  if (problem < kMinChosen) problem = kMinChosen;
  return (problem > kMostChosen ? kMaxContacts : problem) - pushed;
}

// The deepest nodes so far, deepest first; ties: first come.
struct Deepest {
  Real gap_m[kMaxJoining];
  Lane lane[kMaxJoining];
  std::int32_t count = 0, most = 0;
  Real left_out_m = kHuge;  // gap of the deepest without a place
  std::int32_t moves = 0, predicted = 0;

  void offer(const Lane& offered, Real gap) PALPATE_RT {
    if (count == most) {
      const bool joins = most > 0 && gap < gap_m[most - 1];
      left_out_m = min_of(left_out_m, joins ? gap_m[most - 1] : gap);
      if (!joins) return;
    }
    std::int32_t place = count < most ? count++ : most - 1;
    for (; place > 0 && gap < gap_m[place - 1]; --place) {  // bound: kMaxJoining
      gap_m[place] = gap_m[place - 1];
      lane[place] = lane[place - 1];
      moves += 1;
    }
    gap_m[place] = gap;
    lane[place] = offered;
  }
};

// Pushes of the last tick, and the rows of the compliance that they act through.
template <class Number>
struct LastPushes {
  LastPushes(std::span<const Number> compliance, std::size_t row_length, const NodalState& last) PALPATE_RT
      : length(row_length),
        count(last.count) {
    for (std::int32_t j = 0; j < count; ++j) {  // bound: kMaxContacts
      const NodalContact& contact = last.contact[j];
      row[j] = compliance.data() + static_cast<std::size_t>(3 * contact.vertex) * length;
      force_N[j][0] = static_cast<float>(contact.force_w.x);
      force_N[j][1] = static_cast<float>(contact.force_w.y);
      force_N[j][2] = static_cast<float>(contact.force_w.z);
    }
  }
  std::size_t length;
  std::int32_t count;
  const Number* row[kMaxContacts];
  float force_N[kMaxContacts][3];
};

// Gaps of eight nodes where those pushes have moved the body.
template <class Number>
void predict(const LastPushes<Number>& last, const ContactProblem& p, const Lane (&lane)[8], std::int32_t count,
             Deepest& deepest) PALPATE_RT {
  alignas(32) std::int32_t at[8];
  for (std::int32_t i = 0; i < 8; ++i) {  // bound: 8
    const Lane& l = lane[i < count ? i : 0];
    at[i] = 3 * (p.near[l.four].first + l.k);
  }
  deepest.predicted += last.count + 1;
  Float8 x{}, y{}, z{};
  for (std::int32_t j = 0; j < last.count; ++j) {  // bound: kMaxContacts
    const Number* row = last.row[j];
    for (int a = 0; a < 3; ++a, row += last.length) {  // bound: 3
      const Float8 f = splat8(last.force_N[j][a]);
      x += gather8(row, at) * f;
      y += gather8(row + 1, at) * f;
      z += gather8(row + 2, at) * f;
    }
  }
  for (std::int32_t i = 0; i < count; ++i) {  // bound: 8
    const NearFour& near = p.near[lane[i].four];
    const auto k = static_cast<std::uint32_t>(lane[i].k);
    const Vec3 motion{static_cast<Real>(x[i]), static_cast<Real>(y[i]), static_cast<Real>(z[i])};
    deepest.offer(lane[i], near.gap_m[k] + dot(motion - near.carry_w[k], near.normal_w[k]));
  }
}

// Lanes that did not push last tick.
std::uint32_t others_of(const ContactProblem& p, const NearFour& near) PALPATE_RT {
  std::uint32_t others = near.lanes, memory;
  __builtin_memcpy(&memory, p.memory_of + near.first, sizeof memory);
  if (memory == ~0u) return others;
  for (std::uint32_t lanes = near.lanes; lanes != 0; lanes &= lanes - 1) {  // bound: 4
    if (p.memory_of[near.first + std::countr_zero(lanes)] >= 0) others &= ~(lanes & (0u - lanes));
  }
  return others;
}

// Picks the nodes whose displacement is predicted where kMaxPredictions is too few for all: those of the smallest gap,
// found by classes of it, and in turns some of the rest.
class Turns {
 public:
  Turns(const Model& model, const State& state, const ContactProblem& p, const std::uint8_t (&others_of)[kMaxNearFours],
        std::int32_t others) PALPATE_RT : classes_per_m_(0.5 * kClasses / model.params.contact_margin_m) {
    const std::int32_t pushes = state.nodal.count > 0 ? state.nodal.count : 1, most = 8 * (kMaxPredictions / pushes);
    if (others <= most) return;
    std::int32_t in_class[kClasses] = {};
    for (std::int32_t i = 0; i < p.near_count; ++i) {                             // bound: kMaxNearFours
      for (std::uint32_t lanes = others_of[i]; lanes != 0; lanes &= lanes - 1) {  // bound: 4
        in_class[class_of(p.near[i].gap_m[std::countr_zero(lanes)])] += 1;
      }
    }
    window_ = most / 4;
    left_ = most - window_;
    rest_ = others - left_;
    for (; left_ >= in_class[class_]; ++class_) left_ -= in_class[class_];  // bound: kClasses: fewer than all
    const std::uint64_t turn = state.tick % static_cast<std::uint64_t>(rest_);
    next_ = rest_ - 1 - static_cast<std::int32_t>(turn) * window_ % rest_;
  }

  // To be asked of all nodes in one order.
  bool pick(Real gap_m) PALPATE_RT {
    if (rest_ == 0) return true;
    const std::int32_t of_gap = class_of(gap_m);
    if (of_gap < class_) return true;
    if (of_gap == class_ && left_ > 0) {
      left_ -= 1;
      return true;
    }
    next_ = next_ + 1 < rest_ ? next_ + 1 : 0;
    return next_ < window_;
  }

 private:
  static constexpr std::int32_t kClasses = 64;
  std::int32_t class_of(Real gap_m) const PALPATE_RT {
    return static_cast<std::int32_t>(clamp_to(gap_m * classes_per_m_ + 0.5 * kClasses, 0, kClasses - 1));
  }

  const Real classes_per_m_;
  std::int32_t class_ = 0, left_ = 0;              // all classes before this one are picked, and so many of it
  std::int32_t rest_ = 0, window_ = 0, next_ = 0;  // of the rest the first `window_`, counted from a moving start
};

// The deepest of the nodes that did not push; their lanes leave the near ones.
template <class Number>
void find_deepest(const Model& model, const LastPushes<Number>& last, const State& state, ContactProblem& p,
                  Deepest& deepest) PALPATE_RT {
  std::uint8_t others_in[kMaxNearFours];
  std::int32_t others = 0;
  for (std::int32_t i = 0; i < p.near_count; ++i) {  // bound: kMaxNearFours
    const std::uint32_t lanes = others_of(p, p.near[i]);
    others_in[i] = static_cast<std::uint8_t>(lanes);
    others += std::popcount(lanes);
    p.near[i].lanes &= ~lanes;
  }
  Turns turns(model, state, p, others_in, others);
  Lane lane[8];
  std::int32_t count = 0;
  for (std::int32_t i = 0; i < p.near_count; ++i) {                             // bound: kMaxNearFours
    for (std::uint32_t lanes = others_in[i]; lanes != 0; lanes &= lanes - 1) {  // bound: 4
      const std::int32_t k = std::countr_zero(lanes);
      if (!turns.pick(p.near[i].gap_m[k])) continue;
      lane[count++] = {static_cast<std::int16_t>(i), static_cast<std::int16_t>(k)};
      if (count < 8) continue;
      predict(last, p, lane, count, deepest);
      count = 0;
    }
  }
  if (count > 0) predict(last, p, lane, count, deepest);
}

void take(const Model& model, const State& state, ContactProblem& p, const NearFour& near,
          std::int32_t lane) PALPATE_RT {
  const auto k = static_cast<std::uint32_t>(lane);
  ContactNode& node = p.node[p.count++];
  node.vertex = near.first + lane;
  node.piece = near.piece[k];
  node.memory = p.memory_of[node.vertex];
  node.region = node.memory >= 0 ? state.nodal.contact[node.memory].region : -1;
  node.rest_w = model.vertex_m[static_cast<std::size_t>(node.vertex)];
  node.carry_w = near.carry_w[k];
  node.bend_w = near.bend_w[k];
  node.normal_w = near.normal_w[k];
  node.arm_w = near.position_w[k] - state.tool_w.position_m;
  node.gap_m = near.gap_m[k];
}

// Leaves those that pushed last tick and those that join them.
void reduce_near(const Model& model, const State& state, Scratch& scratch) PALPATE_RT {
  ContactProblem& p = problem_of(scratch);
  const auto length = static_cast<std::size_t>(3 * model.sizes.n_vertex);
  Deepest joining;
  joining.most = places_for(state.nodal.count);
  if (model.compliance_f64.empty()) {
    find_deepest(model, LastPushes<float>(model.compliance_f32, length, state.nodal), state, p, joining);
  } else {
    find_deepest(model, LastPushes<double>(model.compliance_f64, length, state.nodal), state, p, joining);
  }
  scratch.work.predicted += joining.predicted;
  scratch.work.offered += joining.moves + p.near_count;
  const Real moved_m = norm(state.tool_w.position_m - state.tool_previous_w.position_m);
  if (joining.left_out_m < -kTolerance_m - moved_m) scratch.status |= Status::kContactsDropped;
  for (std::int32_t n = 0; n < joining.count; ++n) {  // bound: kMaxJoining
    p.near[joining.lane[n].four].lanes |= 1u << joining.lane[n].k;
  }
}

// Lanes that are near a piece.
std::uint32_t lanes_at(const NearFour& near, std::int32_t piece) PALPATE_RT {
  std::uint32_t lanes = 0;
  for (std::uint32_t k = 0; k < 4; ++k) lanes |= near.piece[k] == piece ? 1u << k : 0u;  // bound: 4
  return near.lanes & lanes;
}

}  // namespace

void choose_nodes(const Model& model, const State& state, Scratch& scratch) PALPATE_RT {
  ContactProblem& p = problem_of(scratch);
  std::int32_t near = 0;
  for (std::int32_t i = 0; i < p.near_count; ++i) near += std::popcount(p.near[i].lanes);  // bound: kMaxNearFours
  if (near > kMaxContacts) reduce_near(model, state, scratch);
  p.count = 0;
  const auto pieces = static_cast<std::int32_t>(model.piece.size());
  scratch.work.offered += pieces * p.near_count;
  for (std::int32_t piece = 0; piece < pieces; ++piece) {  // bound: kMaxPieces
    for (std::int32_t i = 0; i < p.near_count; ++i) {      // bound: kMaxNearFours
      std::uint32_t lanes = pieces > 1 ? lanes_at(p.near[i], piece) : p.near[i].lanes;
      for (; lanes != 0; lanes &= lanes - 1) take(model, state, p, p.near[i], std::countr_zero(lanes));  // bound: 4
    }
  }
  scratch.work.found += p.count;
}

}  // namespace palpate
