#include "rt_core/contact/nodes/nodes.h"

#include <utility>

#include "rt_core/cholesky.h"
#include "rt_core/contact/contact.h"
#include "rt_core/image_check.h"
#include "rt_core/tool/articulate.h"
#include "rt_core/tool/shapes.h"

namespace palpate {

namespace {

constexpr std::int32_t kDof = 6;

// Where the tool goes: the handle's pull against the pushes, no faster than the handle itself and the limit.
void place_tool(const Model& model, const State& state, Scratch& scratch, const Twist& drift) PALPATE_RT {
  const ContactProblem& p = problem_of(scratch);
  Pose& tool = scratch.tool_corrected_w;
  if (scratch.driven) {
    tool = state.tool_w;
    return;
  }
  tool = moved(state.tool_w, {drift.translation_m - p.per_N * p.force_N, drift.rotation_rad - p.per_Nm * p.torque_Nm});
  if (scratch.held_by_hand != 0) tool = within_step(model, state, tool, scratch.status);
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
  const ContactProblem& p = problem_of(scratch);
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
    const Pose carrier = carrier_at(model, state, scratch.tool_corrected_w, node.piece);
    const Vec3 bend = contact.friction == FrictionMode::kSlip ? Vec3{} : node.bend_w;
    contact.anchor_tool_m = inverse_transform(carrier, node.rest_w + bend + motion_of(p, i));
  }
}

// Tangent of the contact force for the response of the tool: K = G^T (N C N^T)^-1 G over the pushing nodes, G their
// normals' Jacobian. The factor at hand may contain the coupling's compliance; then S = G^T M^-1 G is K in series with
// it, and K = (1 - S / K_coupling)^-1 S.
void set_stiffness(State& state, Scratch& scratch) PALPATE_RT {
  const ContactProblem& p = problem_of(scratch);
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
  scratch.work.summed += factor.n * (factor.n + 24);
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
void list_contacts(Scratch& scratch) PALPATE_RT {
  const ContactProblem& p = problem_of(scratch);
  for (std::int32_t i = 0; i < p.count; ++i) {  // bound: kMaxContacts
    const ContactNode& node = p.node[i];
    if (!(node.push.normal_N > 0)) continue;
    Contact& contact = scratch.contact[scratch.contact_count++];
    contact = Contact{};
    contact.row = i;
    contact.piece = node.piece;
    contact.previous = node.region;
    contact.position_w = node.rest_w;
    contact.normal_w = -node.normal_w;
    contact.depth_m = max_of(dot(motion_of(p, i), node.normal_w), 0.0);
    contact.weight = 1;
    contact.force_N = node.push.normal_N;
  }
}

// Total wrench on the tool and elastic energy of the body, f . C f / 2.
void sum_up(Scratch& scratch) PALPATE_RT {
  const ContactProblem& p = problem_of(scratch);
  Real work = 0;
  for (std::int32_t i = 0; i < p.count; ++i) {  // bound: kMaxContacts
    const Vec3 force = p.node[i].force_w;
    if (p.node[i].push.normal_N > 0) work += dot(force, motion_of(p, i));
  }
  scratch.contact_wrench_w = {-p.force_N, -p.torque_Nm};
  scratch.energy_J = 0.5 * work;
}

constexpr std::int32_t kMostVectors = whole_lanes(6 * kMaxStrainGauges, 8) / 8;

// Strain components of all pushes, sizeof...(k) vectors of eight: what the registers hold. The last vector ends with
// the last component; what it shares with the one before comes out the same twice. Single precision, as the gauges are.
template <std::int32_t... k>
void add_strains(const float* gauges, const std::int32_t* row, const float* force, std::int32_t rows,
                 std::int32_t components, float* strain, std::integer_sequence<std::int32_t, k...>) PALPATE_RT {
  const std::int32_t end = components - 8;
  Float8 sum[] = {(static_cast<void>(k), Float8{})...};
  for (std::int32_t r = 0; r < rows; ++r) {  // bound: 3 kMaxContacts
    const Float8 f = splat8(force[r]);
    const float* from = gauges + row[r];
    ((sum[k] += load8(from + (k + 1 == sizeof...(k) ? end : 8 * k)) * f), ...);
  }
  (store(strain + (k + 1 == sizeof...(k) ? end : 8 * k), sum[k]), ...);
}

// Picks the number of vectors, from `most` down to 1.
template <std::int32_t most>
void add_strains(const float* gauges, const std::int32_t* row, const float* force, std::int32_t rows,
                 std::int32_t components, float* strain) PALPATE_RT {
  if constexpr (most > 1) {
    if (components <= 8 * (most - 1)) return add_strains<most - 1>(gauges, row, force, rows, components, strain);
  }
  add_strains(gauges, row, force, rows, components, strain, std::make_integer_sequence<std::int32_t, most>());
}

// Largest equivalent strain over the image's gauges under the pushes of the problem; 0 without gauges. Equivalent:
// sqrt(2/3) times the Frobenius norm, which is the axial strain of an incompressible bar. Bound: kMaxContacts times
// 18 kMaxStrainGauges multiplications.
Real largest_strain(const Model& model, const ContactProblem& p) PALPATE_RT {
  const auto components = static_cast<std::int32_t>(model.sizes.n_strain_gauge / (3 * model.sizes.n_vertex));
  std::int32_t row[3 * kMaxContacts];
  float force[3 * kMaxContacts];
  std::int32_t rows = 0;
  for (std::int32_t i = 0; i < p.count; ++i) {  // bound: kMaxContacts
    if (!(p.node[i].push.normal_N > 0)) continue;
    const Vec3 f = p.node[i].force_w;
    const Real by_axis[3] = {f.x, f.y, f.z};
    for (std::int32_t a = 0; a < 3; ++a, ++rows) {
      row[rows] = (3 * p.node[i].vertex + a) * components;
      force[rows] = static_cast<float>(by_axis[a]);
    }
  }
  alignas(32) float strain[6 * kMaxStrainGauges] = {};
  if (components >= 8) {
    add_strains<kMostVectors>(model.strain_gauge.data(), row, force, rows, components, strain);
  } else {
    for (std::int32_t r = 0; r < rows; ++r) {  // bound: 3 kMaxContacts, of one gauge
      for (std::int32_t c = 0; c < components; ++c)
        strain[c] += model.strain_gauge[static_cast<std::size_t>(row[r] + c)] * force[r];
    }
  }
  Real largest2 = 0;
  for (std::int32_t c = 0; c < components; c += 6) {  // bound: kMaxStrainGauges
    Real e[6];
    for (int k = 0; k < 6; ++k) e[k] = static_cast<Real>(strain[c + k]);
    const Real sum = e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + 2 * (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
    largest2 = max_of(largest2, sum);
  }
  return square_root(2.0 / 3.0 * largest2);
}

void check_strain(const Model& model, Scratch& scratch) PALPATE_RT {
  if (model.strain_gauge.empty()) return;
  const auto components = static_cast<std::int32_t>(model.sizes.n_strain_gauge / (3 * model.sizes.n_vertex));
  scratch.work.summed += 3 * scratch.contact_count * (components + 7) / 8;
  scratch.strain = largest_strain(model, problem_of(scratch));
  if (scratch.strain > model.params.strain_limit) scratch.status |= Status::kStrainBeyondLinear;
}

void find_rows(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  scratch.contact_count = 0;
  problem_of(scratch).count = 0;
  if (!is_finite(state.tool_w)) return;
  find_near_nodes(model, state, scratch);
  choose_nodes(model, state, scratch);
  if (problem_of(scratch).count > state.high_water.contacts) state.high_water.contacts = problem_of(scratch).count;
}

void solve(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  ContactProblem& p = problem_of(scratch);
  p.per_N = scratch.driven ? 0.0 : 1.0 / model.params.coupling_N_per_m;
  p.per_Nm = scratch.driven ? 0.0 : 1.0 / model.params.coupling_Nm_per_rad;
  p.force_N = p.torque_Nm = {};
  const Twist drift = scratch.driven ? Twist{} : twist_between(state.tool_w, scratch.grip_w);
  const Pose before = scratch.driven ? state.tool_previous_w : state.safety.tool_corrected_w;
  if (p.count > 0) solve_contacts(model, state, scratch, drift, before);
  place_tool(model, state, scratch, drift);
}

void account(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  if (problem_of(scratch).count > 0) set_stiffness(state, scratch);
  remember(model, state, scratch);
  list_contacts(scratch);
  scratch.work.slid += problem_of(scratch).count;
  sum_up(scratch);
  check_strain(model, scratch);
  find_nodal_regions(model, state, scratch);
}

// A hull's gap needs faces.
ImageResult check_tool(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.piece.size(); ++i)
    if (model.piece[i].shape == PieceShape::kHull && model.piece[i].face_count < 4)
      return not_together("piece.hull_faces", i);
  return {};
}

ImageResult check_vertices(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.nodal_vertex.size(); ++i) {
    const NodalVertex& v = model.nodal_vertex[i];
    if (!is_positive(v.area_m2)) return not_finite("nodal_vertex.area_m2", i);
    if (v.is_free != 0 && v.is_free != 1) return broken("nodal_vertex.is_free", i);
    if (!(v.round_m >= 0 && v.round_m < kHuge)) return not_finite("nodal_vertex.round_m", i);
    if (v.round_m > 0 && !(is_unit(v.round_normal) && v.round_cosine >= 0 && v.round_cosine < 1))
      return not_finite("nodal_vertex.round_normal", i);
  }
  return {};
}

// All of them, in one precision.
ImageResult check_data(const Model& model) noexcept {
  const ModelSizes& n = model.sizes;
  if (n.n_nodal != n.n_vertex) return broken("n_nodal", 0);
  if (n.n_vertex > kMaxNodalVertices) return broken("n_vertex", 0);
  const std::int64_t entries = 9 * n.n_vertex * n.n_vertex;
  if (n.n_compliance_f32 != 0 && n.n_compliance_f64 != 0) return broken("n_compliance_f64", 0);
  if (n.n_compliance_f32 + n.n_compliance_f64 != entries) return broken("n_compliance_f32", 0);
  if (n.n_strain_gauge % (18 * n.n_vertex) != 0) return broken("n_strain_gauge", 0);
  if (n.n_strain_gauge > 18 * n.n_vertex * kMaxStrainGauges) return broken("n_strain_gauge", 0);
  const ModelParams& p = model.params;
  for (const double value : {p.contact_margin_m, p.wall_N_per_m, p.proxy_speed_max_m_per_s})
    if (!(value > 0)) return broken("nodal parameters", 0);
  for (const ImageResult& result :
       {check_vertices(model), check_numbers(model.compliance_f32, "compliance_f32"),
        check_numbers(model.compliance_f64, "compliance_f64"), check_numbers(model.strain_gauge, "strain_gauge")})
    if (result.error != ImageError::kNone) return result;
  return {};
}

// Every node near every piece and carried by every region; all pivots, then all sweeps, twice.
void add_most_work(const Model& model, const SceneSizes& n, Work& work) noexcept {
  const std::int32_t fours = n.nodes / 4 + 1, c = n.contacts, eights = (c + 7) / 8, visits = kMaxFrictionVisits;
  std::int32_t round = 0, planes = 0, faces = 0;
  for (const NodalVertex& vertex : model.nodal_vertex) round += vertex.round_m > 0 ? 1 : 0;
  for (const ToolPiece& piece : model.piece) planes += piece.plane_count, faces += piece.face_count;
  work.planes += planes * (2 * fours + 5);
  work.faces += faces * (fours + round);
  work.fours += n.pieces * fours;
  work.near += n.pieces * fours;
  work.near_regions += n.pieces * fours * n.regions;
  work.rounded += n.pieces * round;
  work.predicted += kMaxPredictions + fours;
  work.offered += fours * (1 + n.pieces) + 4 * fours * c;
  work.found += c;
  work.rows += c;
  work.gathered += 9 * c * eights;
  work.vectors += c * (10 * eights + c / 4) + 27 * c * eights + 18 * visits * eights;
  const std::int32_t pivot = c * (c + 8) * (c + 8) / 24 + 2 * c * (c + 24), sweep = c * ((c + 3) / 4 + 4);
  work.vectors += 2 * (kMaxPivots * pivot + kFallbackSweeps * sweep) + model.params.nodal_sweeps * sweep;
  if (!model.compliance_f64.empty()) work.exact += c * (c + 1) / 2;
  work.frames += (c + 3) / 4;
  work.visits += model.params.friction_sweeps * c;
  work.rubbing += visits + c;
  work.pivots += 2 * kMaxPivots;
  work.slid += c;
  work.rubbed += n.regions;
  work.grouped += c;
  work.joined += c * c + (n.regions + kMaxRegions) * c;
  work.summed += c * (c + 24) + 3 * c * 6 * kMaxStrainGauges / 8;
}

// The problem, and behind it its three lists.
struct ProblemLayout {
  std::size_t near, memory_of, near_of, bytes;
};
ProblemLayout layout_of(const Model& model) noexcept {
  const auto fours = static_cast<std::size_t>(whole_lanes(static_cast<std::int32_t>(model.sizes.n_vertex), 4) / 4);
  static_assert(sizeof(ContactProblem) % alignof(NearFour) == 0);
  const std::size_t near_of = sizeof(ContactProblem) + (fours + 1) * sizeof(NearFour);
  const std::size_t memory_of = near_of + fours * sizeof(std::int16_t);
  return {sizeof(ContactProblem), memory_of, near_of, memory_of + 4 * fours};
}

std::size_t problem_bytes(const Model& model) noexcept { return layout_of(model).bytes; }

void create_problem(const Model& model, void* block) noexcept {
  const ProblemLayout at = layout_of(model);
  auto* bytes = static_cast<std::byte*>(block);
  auto* problem = ::new (static_cast<void*>(block)) ContactProblem;
  problem->near = reinterpret_cast<NearFour*>(bytes + at.near);
  problem->memory_of = reinterpret_cast<std::int8_t*>(bytes + at.memory_of);
  problem->near_of = reinterpret_cast<std::int16_t*>(bytes + at.near_of);
}

}  // namespace

const ContactMethod nodes_method{find_rows,  solve,         account,       check_tool,
                                 check_data, add_most_work, problem_bytes, create_problem};

}  // namespace palpate
