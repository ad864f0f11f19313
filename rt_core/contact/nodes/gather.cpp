#include "rt_core/contact/nodes/nodes.h"

namespace palpate {

namespace {

// to[a][b][i] = row a [index[i] + b] of three rows, for whole lanes of nodes (the rest of the index is 0).
template <class Number>
void pick(const Number* row, std::size_t row_length, const std::int32_t* index, std::int32_t n,
          float (*to)[3][kContactStride]) PALPATE_RT {
  for (std::int32_t i = 0; i < n; i += 8) {  // bound: kMaxContacts / 8
    const Number* from = row;
    for (int a = 0; a < 3; ++a, from += row_length) {  // bound: 3 x 3
      for (int b = 0; b < 3; ++b) store(to[a][b] + i, gather8(from + b, index + i));
    }
  }
}

template <class Number>
void gather_rows(std::span<const Number> compliance, std::size_t row_length, ContactProblem& p) PALPATE_RT {
  alignas(32) std::int32_t index[kContactStride];
  const std::int32_t lanes = whole_lanes(p.count, 8);
  for (std::int32_t i = 0; i < lanes; ++i) index[i] = i < p.count ? 3 * p.node[i].vertex : 0;
  for (std::int32_t j = 0; j < p.count; ++j) {  // bound: kMaxContacts
    const Number* row = compliance.data() + static_cast<std::size_t>(index[j]) * row_length;
    pick(row, row_length, index, lanes, p.influence[j]);
  }
}

void list_directions(const ContactProblem& p, Directions& d) PALPATE_RT {
  const std::int32_t lanes = whole_lanes(p.count, 8);
  for (std::int32_t i = 0; i < lanes; ++i) {  // bound: kMaxContacts
    const Vec3 n = i < p.count ? p.node[i].normal_w : Vec3{};
    const Vec3 m = i < p.count ? cross(p.node[i].arm_w, n) : Vec3{};
    d.normal[0][i] = n.x;
    d.normal[1][i] = n.y;
    d.normal[2][i] = n.z;
    d.turn[0][i] = m.x;
    d.turn[1][i] = m.y;
    d.turn[2][i] = m.z;
    d.narrow[0][i] = static_cast<float>(n.x);
    d.narrow[1][i] = static_cast<float>(n.y);
    d.narrow[2][i] = static_cast<float>(n.z);
    d.narrow_turn[0][i] = static_cast<float>(m.x);
    d.narrow_turn[1][i] = static_cast<float>(m.y);
    d.narrow_turn[2][i] = static_cast<float>(m.z);
  }
}

// Row j of the normal compliance, from the vector of its diagonal on, in single precision as the table is: its rounding
// is a hundredth of the regularisation.
void normal_row(ContactProblem& p, std::int32_t j) PALPATE_RT {
  const Vec3 n = p.node[j].normal_w, turn = p.per_Nm * cross(p.node[j].arm_w, n);
  const float own[3] = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
  const float own_turn[3] = {static_cast<float>(turn.x), static_cast<float>(turn.y), static_cast<float>(turn.z)};
  const float per_N = static_cast<float>(p.per_N);
  const auto& from = p.influence[j];
  for (std::int32_t i = j / 8 * 8; i < p.count; i += 8) {  // bound: kMaxContacts / 8
    Float8 row{};
    for (int b = 0; b < 3; ++b) {
      const Float8 u = load8(from[0][b] + i) * splat8(own[0]) + load8(from[1][b] + i) * splat8(own[1]) +
                       load8(from[2][b] + i) * splat8(own[2]) + splat8(per_N * own[b]);
      row += u * load8(p.directions.narrow[b] + i) + load8(p.directions.narrow_turn[b] + i) * splat8(own_turn[b]);
    }
    float narrow[8];
    store(narrow, row);
    store(p.normal.compliance[j] + i, widen4(narrow));
    store(p.normal.compliance[j] + i + 4, widen4(narrow + 4));
  }
}

// The same from double-precision tables, without their rounding to single.
void normal_row_exact(const Model& model, ContactProblem& p, std::int32_t j) PALPATE_RT {
  const Vec3 n = p.node[j].normal_w, turn = p.per_Nm * cross(p.node[j].arm_w, n);
  const auto length = static_cast<std::size_t>(3 * model.sizes.n_vertex);
  const double* row = model.compliance_f64.data() + static_cast<std::size_t>(3 * p.node[j].vertex) * length;
  for (std::int32_t i = j; i < p.count; ++i) {  // bound: kMaxContacts
    const auto at = static_cast<std::size_t>(3 * p.node[i].vertex);
    const Vec3 x{row[at], row[at + 1], row[at + 2]};
    const Vec3 y{row[length + at], row[length + at + 1], row[length + at + 2]};
    const Vec3 z{row[2 * length + at], row[2 * length + at + 1], row[2 * length + at + 2]};
    const Vec3 u = n.x * x + n.y * y + n.z * z + p.per_N * n;
    p.normal.compliance[j][i] = dot(u, p.node[i].normal_w) + dot(turn, cross(p.node[i].arm_w, p.node[i].normal_w));
  }
}

// The lower triangle from the upper one, which rows hold from the vector of their diagonal on.
void mirror(NormalProblem& p) PALPATE_RT {
  for (std::int32_t j = 0; j < p.n; j += 4) {  // bound: kMaxContacts^2 / 32 blocks
    for (std::int32_t a = 1; a < 4; ++a)
      for (std::int32_t b = 0; b < a; ++b) p.compliance[j + a][j + b] = p.compliance[j + b][j + a];
    for (std::int32_t i = j + 4; i < p.n; i += 4) {
      Double4 block[4] = {load4(p.compliance[j] + i), load4(p.compliance[j + 1] + i), load4(p.compliance[j + 2] + i),
                          load4(p.compliance[j + 3] + i)};
      transpose(block);
      store(p.compliance[i] + j, block[0]);
      store(p.compliance[i + 1] + j, block[1]);
      store(p.compliance[i + 2] + j, block[2]);
      store(p.compliance[i + 3] + j, block[3]);
    }
  }
}

}  // namespace

void add_push(ContactProblem& p, std::int32_t j, Vec3 force) PALPATE_RT {
  const Float8 x = splat8(static_cast<float>(force.x)), y = splat8(static_cast<float>(force.y)),
               z = splat8(static_cast<float>(force.z));
  const float* from = p.influence[j][0][0];
  float* to = p.motion_m[0];
  for (std::int32_t i = 0; i < p.count; i += 8, from += 8, to += 8) {  // bound: kMaxContacts / 8
    for (int b = 0; b < 3; ++b) {                                      // bound: 3
      const Float8 by_x = load8(from + b * kContactStride) * x, by_y = load8(from + (3 + b) * kContactStride) * y,
                   by_z = load8(from + (6 + b) * kContactStride) * z;
      store(to + b * kContactStride, load8(to + b * kContactStride) + (by_x + by_y + by_z));
    }
  }
  p.force_N += force;
  p.torque_Nm += cross(p.node[j].arm_w, force);
}

namespace {

// Adds their displacements to the nodes from i on, so many lanes of eight.
template <int lanes>
void add_to_lanes(ContactProblem& p, const std::int32_t* row, const float* force, std::int32_t count,
                  std::int32_t i) PALPATE_RT {
  Float8 u[3][std::size_t{lanes}];
  for (int b = 0; b < 3; ++b) {  // bound: 3 x 2
    for (int l = 0; l < lanes; ++l) u[b][l] = load8(p.motion_m[b] + i + 8 * l);
  }
  const float* first = p.influence[0][0][0] + i;
  for (std::int32_t k = 0; k < count; ++k, force += 3) {  // bound: kMaxContacts
    const float* from = first + row[k];
    for (int a = 0; a < 3; ++a) {  // bound: 3 x 3 x 2
      const Float8 s = splat8(force[a]);
      for (int b = 0; b < 3; ++b) {
        for (int l = 0; l < lanes; ++l) u[b][l] += load8(from + (3 * a + b) * kContactStride + 8 * l) * s;
      }
    }
  }
  for (int b = 0; b < 3; ++b) {  // bound: 3 x 2
    for (int l = 0; l < lanes; ++l) store(p.motion_m[b] + i + 8 * l, u[b][l]);
  }
}

}  // namespace

// One pass over the influences of all pushes that there are, with the sums in registers: half the instructions of as
// many add_push().
void add_pushes(ContactProblem& p, const float (&force)[3 * kMaxContacts]) PALPATE_RT {
  std::int32_t row[kMaxContacts], count = 0;  // of the influences
  float some[3 * kMaxContacts];
  for (std::int32_t j = 0; j < p.count; ++j) {  // bound: kMaxContacts
    const float x = force[3 * j], y = force[3 * j + 1], z = force[3 * j + 2];
    if (x == 0 && y == 0 && z == 0) continue;
    row[count] = j * 9 * kContactStride;
    some[3 * count] = x;
    some[3 * count + 1] = y;
    some[3 * count + 2] = z;
    count += 1;
  }
  std::int32_t i = 0;
  for (; i + 8 < p.count; i += 16) add_to_lanes<2>(p, row, some, count, i);  // bound: kMaxContacts / 16
  if (i < p.count) add_to_lanes<1>(p, row, some, count, i);
}

// With the tool's own motion F / k + (T x arm) / k_turn: T x arm . n = T . (arm x n).
void find_normal_gaps(const ContactProblem& p, double (&gap)[kContactStride]) PALPATE_RT {
  const Directions& d = p.directions;
  const Vec3 shift = p.per_N * p.force_N, turn = p.per_Nm * p.torque_Nm;
  for (std::int32_t i = 0; i < p.count; i += 4) {  // bound: kMaxContacts / 4
    const auto along = [&](const float* u, const double* n, double s, const double* m, double t)
                           PALPATE_RT { return (widen4(u + i) + splat4(s)) * load4(n + i) + load4(m + i) * splat4(t); };
    store(gap + i, load4(p.offset_m + i) + along(p.motion_m[0], d.normal[0], shift.x, d.turn[0], turn.x) +
                       along(p.motion_m[1], d.normal[1], shift.y, d.turn[1], turn.y) +
                       along(p.motion_m[2], d.normal[2], shift.z, d.turn[2], turn.z));
  }
}

void gather_influence(const Model& model, ContactProblem& p) PALPATE_RT {
  const auto length = static_cast<std::size_t>(3 * model.sizes.n_vertex);
  if (model.compliance_f64.empty()) {
    gather_rows(model.compliance_f32, length, p);
  } else {
    gather_rows(model.compliance_f64, length, p);
  }
}

void gather_normal(const Model& model, ContactProblem& p) PALPATE_RT {
  p.normal.n = p.count;
  p.normal.vectors = 0;
  list_directions(p, p.directions);
  for (std::int32_t j = 0; j < p.count; ++j) {  // bound: kMaxContacts
    if (model.compliance_f64.empty()) {
      normal_row(p, j);
    } else {
      normal_row_exact(model, p, j);
    }
    double& diagonal = p.normal.compliance[j][j];
    diagonal *= 1.0 + model.params.regularisation;
    if (is_held(model, p.node[j])) diagonal += 1.0 / model.params.wall_N_per_m;
  }
  mirror(p.normal);
}

namespace {

// A number of four nodes; past the last one, of the last.
template <class Get>
Double4 of_four(const ContactProblem& p, std::int32_t i, Get&& get) PALPATE_RT {
  const std::int32_t last = p.count - 1;
  const auto at = [&](std::int32_t k) PALPATE_RT { return get(i + k < last ? i + k : last); };
  return Double4{at(0), at(1), at(2), at(3)};
}

// Compliance of four nodes to their own push, in world axes.
struct OwnCompliance {
  Double4 xx, xy, xz, yy, yz, zz;
  Vec3x4 times(const Vec3x4& f) const PALPATE_RT {
    return {xx * f.x + xy * f.y + xz * f.z, xy * f.x + yy * f.y + yz * f.z, xz * f.x + yz * f.y + zz * f.z};
  }
};
OwnCompliance own_compliance(const ContactProblem& p, std::int32_t i) PALPATE_RT {
  const auto entry = [&](int a, int b) PALPATE_RT {
    return of_four(p, i, [&](std::int32_t k) PALPATE_RT { return static_cast<Real>(p.influence[k][a][b][k]); });
  };
  const Vec3x4 r{of_four(p, i, [&](std::int32_t k) PALPATE_RT { return p.node[k].arm_w.x; }),
                 of_four(p, i, [&](std::int32_t k) PALPATE_RT { return p.node[k].arm_w.y; }),
                 of_four(p, i, [&](std::int32_t k) PALPATE_RT { return p.node[k].arm_w.z; })};
  const Vec3x4 turn{p.per_Nm * r.x, p.per_Nm * r.y, p.per_Nm * r.z};
  const Double4 stretch = p.per_N + dot(turn, r);  // (r x f) x r = r.r f - r.f r
  return {entry(0, 0) + stretch - turn.x * r.x, entry(0, 1) - turn.x * r.y, entry(0, 2) - turn.x * r.z,
          entry(1, 1) + stretch - turn.y * r.y, entry(1, 2) - turn.y * r.z, entry(2, 2) + stretch - turn.z * r.z};
}

// Any two tangents (Duff et al. 2017).
void any_tangents(const Vec3x4& n, Vec3x4 (&t)[2]) PALPATE_RT {
  const Double4 zero{}, one = zero + 1, sign = n.z < 0 ? -one : one;
  const Double4 a = -1 / (sign + n.z), b = n.x * n.y * a;
  t[0] = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  t[1] = {b, sign + n.y * n.y * a, -n.y};
}

}  // namespace

void make_frames(const Model& model, ContactProblem& p, Real mu) PALPATE_RT {
  for (std::int32_t i = 0; i < p.count; i += 4) {  // bound: kMaxContacts / 4
    Vec3x4 frame[3];
    frame[0] = {of_four(p, i, [&](std::int32_t k) PALPATE_RT { return p.node[k].normal_w.x; }),
                of_four(p, i, [&](std::int32_t k) PALPATE_RT { return p.node[k].normal_w.y; }),
                of_four(p, i, [&](std::int32_t k) PALPATE_RT { return p.node[k].normal_w.z; })};
    Vec3x4 tangent[2];
    any_tangents(frame[0], tangent);
    frame[1] = tangent[0];
    frame[2] = tangent[1];
    const OwnCompliance own = own_compliance(p, i);
    const Double4 wall = of_four(p, i, [&](std::int32_t k) PALPATE_RT {
      return is_held(model, p.node[k]) ? 1.0 / model.params.wall_N_per_m : 0.0;
    });
    Double4 w[3][3];
    for (int a = 0; a < 3; ++a) {  // bound: 3 x 3
      const Vec3x4 u = own.times(frame[a]);
      for (int b = 0; b <= a; ++b) w[a][b] = w[b][a] = dot(u, frame[b]);
      w[a][a] = w[a][a] * (1.0 + model.params.regularisation) + wall;
    }
    const FrictionBlockOf<Double4> block = make_friction_block(w, mu);
    const Double4 c = block.cosine, s = block.sine;
    const Vec3x4 turned[2] = {
        {c * frame[1].x + s * frame[2].x, c * frame[1].y + s * frame[2].y, c * frame[1].z + s * frame[2].z},
        {c * frame[2].x - s * frame[1].x, c * frame[2].y - s * frame[1].y, c * frame[2].z - s * frame[1].z}};
    for (std::int32_t k = 0; k < 4 && i + k < p.count; ++k) {  // bound: 4
      ContactNode& node = p.node[i + k];
      for (int t = 0; t < 2; ++t) {
        node.tangent_w[t] = {turned[t].x[k], turned[t].y[k], turned[t].z[k]};
        node.block.lean[t] = block.lean[t][k];
        node.block.slide[t] = block.slide[t][k];
        node.block.per_slide[t] = block.per_slide[t][k];
      }
      node.block.normal = block.normal[k];
      node.block.per_normal = block.per_normal[k];
    }
  }
}

}  // namespace palpate
