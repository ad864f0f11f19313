#include "rt_core/contact/nodes/nodes.h"
#include "rt_core/tool/articulate.h"

namespace palpate {

namespace {

// A tick has not converged when the normal problem is left with more than this: pivoting leaves rounding (1e-12 m), the
// sweeps it falls back to, or those that the image asks for, perhaps not. A push of 0.01 N then has 1e-9 N m.
constexpr Real kNormalTolerance_m = 1e-7;
// Or when friction, which its cone cuts after the last normal solution, leaves more than an encoder's step. It leaves
// up to 1e-5 m under sixty nodes that turn back at 0.2 m/s and 2.5e-5 m in a pinch that is torn off, below 1e-6 m in
// steady motion (2026-11-21).
constexpr Real kFrictionTolerance_m = 30e-6;

Real friction_coefficient(const Model& model) PALPATE_RT {
  const bool coulomb = model.params.friction_law == FrictionLaw::kCoulomb;
  return coulomb ? model.params.friction_mu_dynamic : 0.0;
}

class Balance {
 public:
  Balance(const Model& model, State& state, Scratch& scratch, const Twist& drift, const Pose& before) PALPATE_RT
      : model_(model),
        state_(state),
        scratch_(scratch),
        p_(problem_of(scratch)),
        drift_(drift),
        before_(before),
        work_(scratch.work),
        mu_(friction_coefficient(model)) {}

  void run() PALPATE_RT {
    count_gathering();
    gather_influence(model_, p_);
    gather_normal(model_, p_);
    if (mu_ > 0) make_frames(model_, p_, mu_);
    clear_motion();
    if (mu_ > 0) add_remembered_friction();
    solve_normal();
    if (mu_ > 0) solve_with_friction();
    measure();
    work_.vectors += p_.normal.vectors;
    work_.pivots += p_.normal.pivots;
  }

 private:
  std::int32_t eights() const PALPATE_RT { return (p_.count + 7) / 8; }

  // The compliance between the nodes, and of it the rows along their normals.
  void count_gathering() PALPATE_RT {
    const std::int32_t n = p_.count;
    work_.rows += n;
    work_.gathered += 9 * n * eights();
    if (model_.compliance_f64.empty()) {
      work_.vectors += n * (10 * eights() + n / 4);
    } else {
      work_.exact += n * (n + 1) / 2;
    }
    if (mu_ > 0) work_.frames += (n + 3) / 4;
  }
  bool pivots() const PALPATE_RT { return model_.params.nodal_solver == NodalSolver::kPivoting; }

  void clear_motion() PALPATE_RT {
    for (std::int32_t i = 0; i < p_.count; ++i) {  // bound: kMaxContacts
      p_.node[i].push = {};
      p_.node[i].force_w = {};
      p_.node[i].has_offset = false;
    }
    for (auto& row : p_.motion_m) {
      for (std::int32_t i = 0; i < whole_lanes(p_.count, 8); ++i) row[i] = 0;  // bound: kMaxContacts
    }
    p_.force_N = p_.torque_Nm = {};
  }

  // A contact that slipped is remembered without its bend (remember() in nodes.cpp), which follows the last tick's
  // forces: with the bend of then, the change of the bend would count as sliding to and fro. It did until 2026-11-23:
  // whole rows stuck and slipped in turn, and snap_in_paper lost 0.43 N for a tick at 8.17 mm, 2.3 N in every other
  // tick with mu = 0.4.
  void bend_anchor(const ContactNode& node, NodalContact& was) const PALPATE_RT {
    const Pose carrier = carrier_previous_at(model_, state_, before_, node.piece);
    was.anchor_tool_m += rotate(conjugate(carrier.orientation), node.bend_w);
  }

  // How far the body's material at a node is from the tool's material it is compared with, without any push.
  Vec3 free_offset(const ContactNode& node) PALPATE_RT {
    Vec3 anchor_tool;
    if (node.memory >= 0 && state_.nodal.contact[node.memory].piece == node.piece) {
      NodalContact& was = state_.nodal.contact[node.memory];
      if (was.friction == FrictionMode::kSlip) bend_anchor(node, was);
      anchor_tool = was.anchor_tool_m;
    } else {
      anchor_tool = inverse_transform(carrier_previous_at(model_, state_, before_, node.piece),
                                      node.rest_w + node.carry_w + node.bend_w);
    }
    if (node.piece != carried_piece_) {
      carried_piece_ = node.piece;
      carrier_ = carrier_w(model_, state_, node.piece);
    }
    return node.rest_w + node.bend_w - transform(carrier_, anchor_tool) - tool_motion(node);
  }
  Vec3 tool_motion(const ContactNode& node) const PALPATE_RT {
    return drift_.translation_m + cross(drift_.rotation_rad, node.arm_w);
  }

  // Tangential displacement without any push, once the node is known to push.
  void set_offset(ContactNode& node) PALPATE_RT {
    const Vec3 offset = free_offset(node);
    node.offset_m[0] = dot(offset, node.tangent_w[0]);
    node.offset_m[1] = dot(offset, node.tangent_w[1]);
    node.has_offset = true;
  }

  // Starts from last tick's friction.
  void add_remembered_friction() PALPATE_RT {
    for (std::int32_t i = 0; i < p_.count; ++i) {  // bound: kMaxContacts
      ContactNode& node = p_.node[i];
      if (node.memory < 0) continue;
      set_offset(node);
      const Vec3 force = tangential_part(state_.nodal.contact[node.memory].force_w, node.normal_w);
      node.push.tangent_N[0] = dot(force, node.tangent_w[0]);
      node.push.tangent_N[1] = dot(force, node.tangent_w[1]);
      node.push.slips = state_.nodal.contact[node.memory].friction == FrictionMode::kSlip;
    }
    set_forces();
  }

  // Carries node.push over to the forces and displacements.
  void set_force(std::int32_t i) PALPATE_RT {
    ContactNode& node = p_.node[i];
    const Vec3 force = push_w(node);
    const Vec3 step = force - node.force_w;
    node.force_w = force;
    if (squared_norm(step) > 0) add_push(p_, i, step);
  }
  // The same for all nodes at once.
  void set_forces() PALPATE_RT {
    work_.vectors += 9 * p_.count * eights();
    float steps[3 * kMaxContacts];
    for (std::int32_t i = 0; i < p_.count; ++i) {  // bound: kMaxContacts
      ContactNode& node = p_.node[i];
      const Vec3 force = push_w(node), step = force - node.force_w;
      node.force_w = force;
      p_.force_N += step;
      p_.torque_Nm += cross(node.arm_w, step);
      steps[3 * i] = static_cast<float>(step.x);
      steps[3 * i + 1] = static_cast<float>(step.y);
      steps[3 * i + 2] = static_cast<float>(step.z);
    }
    add_pushes(p_, steps);
  }

  void solve_normal() PALPATE_RT {
    NormalProblem& normal = p_.normal;
    for (std::int32_t i = 0; i < p_.count; ++i) {  // bound: kMaxContacts
      const ContactNode& node = p_.node[i];
      p_.offset_m[i] = node.gap_m - dot(node.carry_w + tool_motion(node), node.normal_w);
      normal.push_N[i] =
          node.memory >= 0 ? max_of(dot(state_.nodal.contact[node.memory].force_w, node.normal_w), 0.0) : 0.0;
    }
    for (std::int32_t i = p_.count; i < whole_lanes(p_.count, 4); ++i) p_.offset_m[i] = 0;  // bound: 3
    find_normal_gaps(p_, normal.free_gap_m);
    if (pivots()) {
      solve_pivoting(normal);
    } else {
      normal.pivots = 0;
      solve_sweeping(normal, model_.params.nodal_sweeps);
    }
    for (std::int32_t i = 0; i < p_.count; ++i) p_.node[i].push.normal_N = normal.push_N[i];  // bound: kMaxContacts
    set_forces();
  }

  // False: the node is open and was.
  bool solve_node(std::int32_t i) PALPATE_RT {
    ContactNode& node = p_.node[i];
    const Vec3 u = relative_motion(p_, i);
    const Real normal_m = p_.offset_m[i] + dot(u, node.normal_w);
    if (!node.has_offset) {
      if (node.push.normal_N == 0 && normal_m >= 0) return false;  // open, and stays so
      set_offset(node);
    }
    const Real now_m[3] = {normal_m, node.offset_m[0] + dot(u, node.tangent_w[0]),
                           node.offset_m[1] + dot(u, node.tangent_w[1])};
    node.push = improve_friction(node.block, mu_, node.push, now_m);
    set_force(i);
    return true;
  }

  void solve_with_friction() PALPATE_RT {
    std::int32_t left = kMaxFrictionVisits;
    for (std::int32_t sweep = 0; sweep < model_.params.friction_sweeps && left >= p_.count; ++sweep) {  // bound: 20
      work_.visits += p_.count;
      for (std::int32_t i = 0; i < p_.count; ++i) left -= solve_node(i) ? 1 : 0;  // bound: kMaxContacts
    }
    work_.rubbing += kMaxFrictionVisits - left;
    work_.vectors += 18 * (kMaxFrictionVisits - left) * eights();
    if (pivots()) close_normal_gaps();
  }

  // The sweeps leave the normal gaps of the nodes visited first slightly wrong. With the friction they found, the
  // normal problem is solved once more, from the factor at hand.
  void close_normal_gaps() PALPATE_RT {
    NormalProblem& normal = p_.normal;
    if (normal.factored == 0) return;
    alignas(32) double gap[kContactStride];
    find_normal_residuals(gap);
    if (!close_all(gap)) {
      for (std::int32_t i = 0; i < p_.count; ++i) normal.push_N[i] = p_.node[i].push.normal_N;  // bound: kMaxContacts
      measure_gaps(normal);
      for (std::int32_t i = 0; i < p_.count; ++i) normal.free_gap_m[i] += gap[i] - normal.gap_m[i];
      resolve_pivoting(normal);
    }
    for (std::int32_t i = 0; i < p_.count; ++i) {  // bound: kMaxContacts
      p_.node[i].push.normal_N = normal.push_N[i];
      cut_to_cone(p_.node[i]);
    }
    set_forces();
  }

  // Where all nodes push, and still do without the gaps, one solution suffices. Writes normal.push_N.
  bool close_all(const double (&gap)[kContactStride]) PALPATE_RT {
    NormalProblem& normal = p_.normal;
    if (normal.factor.n != p_.count) return false;
    alignas(32) double step[kContactStride] = {};
    for (std::int32_t k = 0; k < p_.count; ++k) {  // bound: kMaxContacts
      if (normal.active[k] < 0) return false;
      step[k] = -gap[normal.active[k]];
    }
    normal.vectors += p_.count * (p_.count + 8) / 4;
    solve_lower(normal.factor, step);
    solve_upper(normal.factor, step);
    bool pushes = true;
    for (std::int32_t k = 0; k < p_.count; ++k) {  // bound: kMaxContacts
      const std::int32_t i = normal.active[k];
      normal.push_N[i] = p_.node[i].push.normal_N + step[k];
      pushes = pushes && normal.push_N[i] >= 0;
    }
    return pushes;
  }

  // Normal gaps with the softening that the regularisation and a wall stand for.
  void find_normal_residuals(double (&gap)[kContactStride]) const PALPATE_RT {
    find_normal_gaps(p_, gap);
    const Real rho = model_.params.regularisation, softening = rho / (1 + rho);
    for (std::int32_t i = 0; i < p_.count; ++i) {  // bound: kMaxContacts
      Real own = softening * p_.normal.compliance[i][i];
      if (is_held(model_, p_.node[i])) own += (1 - softening) / model_.params.wall_N_per_m;
      gap[i] += own * p_.node[i].push.normal_N;
    }
  }

  // The last step changed normal pushes only. Friction beyond their limit becomes that of a slipping contact which
  // alone keeps its gap closed.
  void cut_to_cone(ContactNode& node) const PALPATE_RT {
    const Push& push = node.push;
    const Real limit = mu_ * push.normal_N;
    const Real size2 = push.tangent_N[0] * push.tangent_N[0] + push.tangent_N[1] * push.tangent_N[1];
    if (!(size2 > limit * limit)) return;
    Real own[3];
    own_displacement(node.block, push, own);
    if (!(own[0] > 0 && limit > 0)) {
      node.push.tangent_N[0] = node.push.tangent_N[1] = 0;
      return;
    }
    node.push = slip_along(node.block, mu_, -own[0], push.tangent_N[0], push.tangent_N[1]);
  }

  void measure() PALPATE_RT {
    scratch_.residual_m = p_.normal.residual_m;
    if (mu_ > 0) {
      alignas(32) double gap[kContactStride];
      find_normal_residuals(gap);
      scratch_.residual_m = 0;
      for (std::int32_t i = 0; i < p_.count; ++i) {  // bound: kMaxContacts
        const Real push_m = p_.node[i].push.normal_N * p_.normal.compliance[i][i];
        scratch_.residual_m = max_of(scratch_.residual_m, abs_of(push_m < gap[i] ? push_m : gap[i]));
      }
    }
    const bool converged = p_.normal.residual_m <= kNormalTolerance_m && scratch_.residual_m <= kFrictionTolerance_m;
    if (!converged) scratch_.status |= Status::kNotConverged;
  }

  const Model& model_;
  State& state_;
  Scratch& scratch_;
  ContactProblem& p_;
  const Twist drift_;
  const Pose before_;
  Work& work_;
  const Real mu_;
  Pose carrier_;  // of the piece last asked for
  std::int32_t carried_piece_ = -1;
};

}  // namespace

void solve_contacts(const Model& model, State& state, Scratch& scratch, const Twist& drift,
                    const Pose& tool_before_w) PALPATE_RT {
  Balance(model, state, scratch, drift, tool_before_w).run();
}

}  // namespace palpate
