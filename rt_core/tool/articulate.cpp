#include "rt_core/tool/articulate.h"

#include "rt_core/math.h"
#include "rt_core/tick.h"
#include "rt_core/tool/pose_lanes.h"
#include "rt_core/tool/two_tools.h"

namespace palpate {

namespace {

std::int32_t joint_count(const Model& model) PALPATE_RT {
  const auto n = static_cast<std::int64_t>(model.joint.size());
  return n < kMaxJoints ? static_cast<std::int32_t>(n) : kMaxJoints;
}

const Joint& joint_at(const Model& model, std::int32_t j) PALPATE_RT {
  return model.joint[static_cast<std::size_t>(j)];
}

// Each closing fraction towards its command, at the bounded rate. A command that is no fraction is cut or ignored.
void advance_closing(const Model& model, State& state, Scratch& scratch, const Input& input) PALPATE_RT {
  const double step = model.params.closing_rate_per_s * model.params.period_s;
  for (std::int32_t f = 0; f < kMaxFingers; ++f) {  // bound: kMaxFingers
    double& closing = state.articulation.closing[f];
    const auto wanted = static_cast<double>(input.joints.closing[f]);
    if (!(wanted >= 0 && wanted <= 1)) scratch.status |= Status::kJointLimited;
    double goal = is_finite(wanted) ? clamp_to(wanted, 0, 1) : closing;
    if ((input.buttons & kButtonClose) != 0) goal = 1;
    closing += clamp_to(goal - closing, -step, step);
  }
}

// Where the command wants a joint, within its limits.
double goal_of(const Model& model, const State& state, Scratch& scratch, const Input& input,
               std::int32_t j) PALPATE_RT {
  const Joint& joint = joint_at(model, j);
  if ((input.joints.direct >> j & 1u) == 0) {
    return joint.open + state.articulation.closing[joint.finger] * (joint.closed - joint.open);
  }
  const auto wanted = static_cast<double>(input.joints.target[j]);
  if (!(wanted >= joint.lowest && wanted <= joint.highest)) scratch.status |= Status::kJointLimited;
  return is_finite(wanted) ? clamp_to(wanted, joint.lowest, joint.highest) : state.articulation.joint[j];
}

// Generalised load of a joint by the contact force on a piece it carries: the work per unit of joint motion.
double load_on(const Model& model, const ArticulationState& a, std::int32_t j, std::int32_t piece) PALPATE_RT {
  const Joint& joint = joint_at(model, j);
  const Vec3 force = a.piece_force_tool_N[piece];
  if (joint.kind == JointKind::kSlide) return joint.sign * dot(a.axis_tool[j], force);
  return joint.sign * dot(a.axis_tool[j], a.piece_torque_tool_Nm[piece] - cross(a.origin_tool_m[j], force));
}

// Takes the step from every joint that would press an overloaded piece harder: all joints between the piece and the
// palm, since each of them moves it. A step that gives way is never stopped.
void stop_loaded(const Model& model, const ArticulationState& a, Scratch& scratch,
                 double (&step)[kMaxJoints]) PALPATE_RT {
  const double limit2 = model.params.stop_force_N * model.params.stop_force_N;
  const auto pieces = static_cast<std::int32_t>(model.piece.size());
  for (std::int32_t p = 0; p < pieces; ++p) {  // bound: kMaxPieces * kMaxJoints
    if (!(squared_norm(a.piece_force_tool_N[p]) > limit2)) continue;
    std::int32_t j = model.piece[static_cast<std::size_t>(p)].joint;
    for (std::int32_t up = 0; up < kMaxJoints && j >= 0; ++up) {
      scratch.work.joint_loads += 1;
      if (step[j] * load_on(model, a, j, p) < 0) {
        step[j] = 0;
        scratch.status |= Status::kJointStopped;
      }
      j = joint_at(model, j).parent;
    }
  }
}

// Moves the joints. Returns those that did, as bits, with all that hang on one root.
std::uint32_t move_joints(const Model& model, State& state, Scratch& scratch, const Input& input) PALPATE_RT {
  ArticulationState& a = state.articulation;
  const std::int32_t joints = joint_count(model);
  double step[kMaxJoints] = {};
  for (std::int32_t j = 0; j < joints; ++j) {  // bound: kMaxJoints
    const double fastest = joint_at(model, j).speed_max * model.params.period_s;
    step[j] = clamp_to(goal_of(model, state, scratch, input, j) - a.joint[j], -fastest, fastest);
  }
  stop_loaded(model, a, scratch, step);
  std::uint32_t of_root[kMaxJoints] = {}, moved = 0;
  std::int32_t root[kMaxJoints];
  for (std::int32_t j = 0; j < joints; ++j) {  // bound: kMaxJoints
    const std::int32_t parent = joint_at(model, j).parent;
    root[j] = parent < 0 ? j : root[parent];
    of_root[root[j]] |= 1u << j;
    if (step[j] == 0) continue;
    a.joint[j] = clamp_to(a.joint[j] + step[j], joint_at(model, j).lowest, joint_at(model, j).highest);
    moved |= 1u << root[j];
  }
  std::uint32_t with_it = 0;
  for (std::int32_t j = 0; j < joints; ++j)
    with_it |= (moved >> root[j] & 1) != 0 ? of_root[root[j]] : 0;  // kMaxJoints
  return with_it;
}

void place_pieces(const Model& model, ArticulationState& a, std::uint32_t which) PALPATE_RT {
  Pose link[kMaxJoints];
  place_links(model, a.joint.data(), link, a.axis_tool.data(), a.origin_tool_m.data(), which);
  for (std::int32_t p = 0; p < a.motion_tool.size(); ++p) {  // bound: kMaxPieces
    const std::int32_t j = model.piece[static_cast<std::size_t>(p)].joint;
    if (j >= 0 && (which >> j & 1) != 0) a.motion_tool[p] = link[j] * joint_at(model, j).zero_inverse;
  }
}

void keep_previous(ArticulationState& a) PALPATE_RT {
  for (std::int32_t p = 0; p < a.motion_tool.size(); ++p) a.motion_previous_tool[p] = a.motion_tool[p];
}

// Force and torque of a piece's contacts, x, y, z and a number of which nobody asks.
struct PieceLoad {
  Double4 force_w, torque_w;
};

// Of the contacts from `i` on that are of one piece. Returns the first that is not.
static_assert(offsetof(Contact, position_w) + 32 <= sizeof(Contact) &&
              offsetof(Contact, normal_w) + 32 <= sizeof(Contact));
std::int32_t add_up(const Contact* contact, std::int32_t i, std::int32_t contacts, const Double4& origin_w,
                    PieceLoad& load) PALPATE_RT {
  const std::int32_t piece = contact[i].piece;
  for (; i < contacts && contact[i].piece == piece; ++i) {  // bound: kMaxContacts
    if (!(contact[i].force_N > 0)) continue;
    const Double4 pushes_w = splat4(contact[i].force_N) * load4(&contact[i].normal_w.x);
    load.force_w += pushes_w;
    load.torque_w += cross(load4(&contact[i].position_w.x) - origin_w, pushes_w);
  }
  return i;
}

// F_palm = -sum F_i - M g on the body, and its moment about the tool's origin (Cui & Xiao 2008: the palm supports the
// body without deforming it). The fingers' forces on the body are the opposite of those on the tool.
void balance_palm(const Model& model, const State& state, Scratch& scratch) PALPATE_RT {
  constexpr Real kGravity_m_per_s2 = 9.80665;
  const Vec3 up{0, model.params.body_mass_kg * kGravity_m_per_s2, 0};
  const Vec3 centre{model.params.body_centre_x_m, model.params.body_centre_y_m, model.params.body_centre_z_m};
  scratch.palm_w.force_N = scratch.contact_wrench_w.force_N + up;
  scratch.palm_w.torque_Nm = scratch.contact_wrench_w.torque_Nm + cross(centre - state.tool_w.position_m, up);
}

}  // namespace

void place_links(const Model& model, const double* joint, Pose* link_tool, Vec3* axis_tool, Vec3* origin_tool_m,
                 std::uint32_t which) PALPATE_RT {
  const std::int32_t joints = joint_count(model);
  math::SinCos4 half[whole_lanes(kMaxJoints, 4) / 4];
  for (std::int32_t j = 0; j < joints; j += 4) {  // bound: kMaxJoints
    Double4 angle{};
    for (std::int32_t k = 0; k < 4 && j + k < joints; ++k)
      angle[k] = 0.5 * (joint_at(model, j + k).sign * joint[j + k]);
    if ((which >> j & 15) != 0) half[j / 4] = math::sin_cos(angle);
  }
  for (std::int32_t j = 0; j < joints; ++j) {  // bound: kMaxJoints; parents come first
    if ((which >> j & 1) == 0) continue;
    const Joint& row = joint_at(model, j);
    // Where the axis is that of the parent's frame, as in all but a hand's first joints, the product is spared.
    Pose axis = row.before;
    if (row.parent >= 0) axis = axis == Pose{} ? link_tool[row.parent] : link_tool[row.parent] * axis;
    const Vec3 z = rotate(axis.orientation, {0, 0, 1});
    Pose moved = axis;
    if (row.kind == JointKind::kSlide) {
      moved.position_m += row.sign * joint[j] * z;
    } else {
      moved.orientation = axis.orientation * Quat{half[j / 4].cos[j % 4], 0, 0, half[j / 4].sin[j % 4]};
    }
    link_tool[j] = moved * row.after;
    if (axis_tool != nullptr) axis_tool[j] = z;
    if (origin_tool_m != nullptr) origin_tool_m[j] = axis.position_m;
  }
}

void articulate(const Model& model, State& state, Scratch& scratch, const Input& input) PALPATE_RT {
  if (!is_articulated(model)) return;
  if (has_two_tools(model)) return carry_second_tool(model, state, scratch);
  ArticulationState& a = state.articulation;
  scratch.work.joints += joint_count(model) + a.motion_tool.size();
  const bool first = a.started == 0;
  if (first) {
    for (std::int32_t j = 0; j < joint_count(model); ++j) a.joint[j] = joint_at(model, j).open;  // bound: kMaxJoints
    a.started = 1;
  }
  if (a.moved != 0) keep_previous(a);
  advance_closing(model, state, scratch, input);
  const std::uint32_t moved = move_joints(model, state, scratch, input) | (first ? ~0u : 0u);
  a.moved = moved != 0 ? 1 : 0;
  if (a.moved != 0) place_pieces(model, a, moved);
  if (first) keep_previous(a);
}

void load_pieces(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  if (!is_articulated(model) || has_two_tools(model)) return;
  ArticulationState& a = state.articulation;
  a.piece_force_tool_N.fill({});
  a.piece_torque_tool_Nm.fill({});
  const std::int32_t contacts = scratch.contact_count < kMaxContacts ? scratch.contact_count : kMaxContacts;
  const Contact* const contact = scratch.contact.data();
  const Double4 origin_w = lanes_of(state.tool_w.position_m);
  const Quat4 to_tool = conjugate(splat4(state.tool_w).orientation);
  for (std::int32_t i = 0; i < contacts;) {  // bound: kMaxContacts; those of a piece follow one another
    std::int32_t piece[2] = {contact[i].piece, -1};
    PieceLoad load[2] = {};
    i = add_up(contact, i, contacts, origin_w, load[0]);
    if (i < contacts) {
      piece[1] = contact[i].piece;
      i = add_up(contact, i, contacts, origin_w, load[1]);
    }
    Double4 of[4] = {load[0].force_w, load[0].torque_w, load[1].force_w, load[1].torque_w};
    transpose(of);
    const Vec3x4 at_tool = rotate(to_tool, Vec3x4{of[0], of[1], of[2]});
    for (std::uint32_t k = 0; k < 2 && piece[k] >= 0; ++k) {  // bound: 2
      a.piece_force_tool_N[piece[k]] += at_tool[2 * k];
      a.piece_torque_tool_Nm[piece[k]] += at_tool[2 * k + 1];
    }
  }
  if (model.params.articulation == Articulation::kHand) balance_palm(model, state, scratch);
}

}  // namespace palpate
