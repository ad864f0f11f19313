#include "rt_core/cholesky.h"
#include "rt_core/contact/nodes/balance.h"
#include "rt_core/contact/nodes/gather.h"
#include "rt_core/contact/nodes/nodal.h"
#include "rt_core/contact/nodes/strain.h"
#include "rt_core/tool/articulate.h"
#include "rt_core/tool/carrier.h"

namespace palpate {

namespace {

constexpr std::int32_t kDof = 6;

void clear_outputs(State& state, Scratch& scratch) PALPATE_RT {
  scratch.contact_wrench_w = {};
  scratch.energy_J = 0;
  scratch.residual_m = 0;
  scratch.contact_count = 0;
  scratch.strain = 0;
  for (Real& entry : state.contact_stiffness) entry = 0;  // bound: 36
}

// Where the tool goes: the handle's pull against the pushes, no faster than the handle itself and the limit.
void place_tool(const Model& model, const State& state, Scratch& scratch, const Twist& drift) PALPATE_RT {
  const ContactProblem& p = scratch.nodal;
  Pose& tool = scratch.tool_corrected_w;
  if (scratch.driven) {
    tool = state.tool_w;
    return;
  }
  tool = moved(state.tool_w, {drift.translation_m - p.per_N * p.force_N, drift.rotation_rad - p.per_Nm * p.torque_Nm});
  const bool touching = squared_norm(p.force_N) > 0 || state.nodal.count > 0;
  if (!touching) return;
  const Twist step = twist_between(state.safety.tool_corrected_w, tool);
  const Real most = model.params.proxy_speed_max_m_per_s * model.params.period_s +
                    norm(state.device_w.position_m - state.device_previous_w.position_m);
  const Real length = norm(step.translation_m);
  if (!(length > most)) return;
  const Real share = most / length;
  tool = moved(state.safety.tool_corrected_w, {share * step.translation_m, share * step.rotation_rad});
}

// Keeps the nodes that push: with what force, and where on the tool.
void remember(const Model& model, State& state, const Scratch& scratch) PALPATE_RT {
  const ContactProblem& p = scratch.nodal;
  NodalContact before[kMaxContacts];
  for (std::int32_t m = 0; m < state.nodal.count; ++m) before[m] = state.nodal.contact[m];  // bound: kMaxContacts
  state.nodal.count = 0;
  for (std::int32_t i = 0; i < p.count; ++i) {  // bound: kMaxContacts
    const ContactNode& node = p.node[i];
    if (!(node.push.normal_N > 0)) continue;
    NodalContact& contact = state.nodal.contact[state.nodal.count++];
    contact = NodalContact{};
    contact.vertex = node.vertex;
    contact.piece = node.piece;
    contact.region = node.region;
    contact.force_w = node.force_w;
    contact.friction = node.push.slips ? FrictionMode::kSlip : FrictionMode::kStick;
    const bool stays = node.memory >= 0 && before[node.memory].piece == node.piece;
    if (contact.friction == FrictionMode::kStick && stays) {
      contact.anchor_tool_m = before[node.memory].anchor_tool_m;
      continue;
    }
    const Pose carrier = is_articulated(model) ? scratch.tool_corrected_w * state.articulation.motion_tool[node.piece]
                                               : scratch.tool_corrected_w;
    contact.anchor_tool_m = inverse_transform(carrier, node.rest_w + node.bend_w + motion_of(p, i));
  }
}

// Tangent of the contact force for the response of the tool: K = G^T (N C N^T)^-1 G over the pushing nodes, G their
// normals' Jacobian. The factor at hand may contain the coupling's compliance; then S = G^T M^-1 G is K in series with
// it, and K = (1 - S / K_coupling)^-1 S.
void set_stiffness(State& state, const Scratch& scratch) PALPATE_RT {
  const ContactProblem& p = scratch.nodal;
  const ContactFactor& factor = p.normal.factor;
  if (p.normal.factored == 0 || factor.n == 0) return;
  FactorRow column[kContactStride];
  const Real root[2] = {p.per_N > 0 ? square_root(p.per_N) : 1.0, p.per_Nm > 0 ? square_root(p.per_Nm) : 1.0};
  for (std::int32_t k = 0; k < factor.n; ++k) {  // bound: kMaxContacts
    const bool real = p.normal.active[k] >= 0;
    const ContactNode& node = p.node[real ? p.normal.active[k] : 0];
    const Vec3 n = real ? root[0] * node.normal_w : Vec3{};
    const Vec3 m = real ? root[1] * cross(node.arm_w, node.normal_w) : Vec3{};
    column[k] = {{n.x, n.y, n.z, m.x, m.y, m.z, 0, 0}};
  }
  solve_lower(factor, column);
  Real series[kDof * kDof], rest[kDof * kDof];
  Double4 product[kDof][2] = {};
  for (std::int32_t k = 0; k < factor.n; ++k) {  // bound: kMaxContacts
    const Double4 low = load4(column[k].entry), high = load4(column[k].entry + 4);
    for (std::int32_t a = 0; a < kDof; ++a) {  // bound: 6
      const Double4 s = splat4(column[k].entry[a]);
      product[a][0] += low * s;
      product[a][1] += high * s;
    }
  }
  for (std::int32_t a = 0; a < kDof; ++a) {  // bound: 6 x 6
    for (std::int32_t b = 0; b <= a; ++b) series[a * kDof + b] = series[b * kDof + a] = product[a][b / 4][b % 4];
  }
  const bool coupled = p.per_N > 0;
  for (std::int32_t e = 0; e < kDof * kDof; ++e) rest[e] = -series[e];
  for (std::int32_t a = 0; a < kDof; ++a) rest[a * (kDof + 1)] = 1.0 + 1e-9 - series[a * (kDof + 1)];
  if (coupled && !cholesky_factor(rest, kDof)) return;
  for (std::int32_t a = 0; a < kDof; ++a) {  // bound: 6
    Real x[kDof];
    for (std::int32_t b = 0; b < kDof; ++b) x[b] = series[a * kDof + b];
    if (coupled) cholesky_solve(rest, x, kDof);
    for (std::int32_t b = 0; b < kDof; ++b) state.contact_stiffness[a * kDof + b] = x[b] / (root[a / 3] * root[b / 3]);
  }
}

// Contacts for the later stages and telemetry: the nodes that push.
void list_contacts(State& state, Scratch& scratch) PALPATE_RT {
  const ContactProblem& p = scratch.nodal;
  for (std::int32_t i = 0; i < p.count; ++i) {  // bound: kMaxContacts
    const ContactNode& node = p.node[i];
    state.point[i].region = node.region;
    if (!(node.push.normal_N > 0)) continue;
    Contact& contact = scratch.contact[scratch.contact_count++];
    contact = Contact{};
    contact.point = i;
    contact.region = -1;
    contact.piece = node.piece;
    contact.position_w = node.rest_w;
    contact.normal_w = -node.normal_w;
    contact.depth_m = max_of(dot(motion_of(p, i), node.normal_w), 0.0);
    contact.weight = 1;
    contact.force_N = node.push.normal_N;
  }
}

// Total wrench on the tool and elastic energy of the body, f . C f / 2.
void sum_up(Scratch& scratch) PALPATE_RT {
  const ContactProblem& p = scratch.nodal;
  Real work = 0;
  for (std::int32_t i = 0; i < p.count; ++i) {  // bound: kMaxContacts
    const Vec3 force = p.node[i].force_w;
    if (p.node[i].push.normal_N > 0) work += dot(force, motion_of(p, i));
  }
  scratch.contact_wrench_w = {-p.force_N, -p.torque_Nm};
  scratch.energy_J = 0.5 * work;
}

void check_strain(const Model& model, Scratch& scratch) PALPATE_RT {
  if (model.strain_gauge.empty()) return;
  scratch.strain = largest_strain(model, scratch.nodal);
  if (scratch.strain > model.params.strain_limit) scratch.status |= Status::kStrainBeyondLinear;
}

}  // namespace

void compute_nodal_force(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  clear_outputs(state, scratch);
  ContactProblem& p = scratch.nodal;
  p.per_N = scratch.driven ? 0.0 : 1.0 / model.params.coupling_N_per_m;
  p.per_Nm = scratch.driven ? 0.0 : 1.0 / model.params.coupling_Nm_per_rad;
  p.force_N = p.torque_Nm = {};
  const Twist drift = scratch.driven ? Twist{} : twist_between(state.tool_w, state.device_w);
  const Pose before = scratch.driven ? state.tool_previous_w : state.safety.tool_corrected_w;
  if (p.count > 0) solve_contacts(model, state, scratch, drift, before);
  place_tool(model, state, scratch, drift);
  if (p.count > 0) set_stiffness(state, scratch);
  remember(model, state, scratch);
  list_contacts(state, scratch);
  sum_up(scratch);
  check_strain(model, scratch);
  find_nodal_regions(model, state, scratch);
  if (is_articulated(model)) load_pieces(model, state, scratch);
}

}  // namespace palpate
