#include "config/bake/drawn_fields.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "config/bake/sample_field.h"
#include "config/elastic/fixed_random.h"
#include "config/elastic/half_space_patch.h"
#include "rt_core/contact/elastic/drawn_shapes.h"

namespace palpate {

namespace {

using elastic::vec;
using elastic::Vector;

// Towards no width by so much of the two patches' parabola: contacts are a third to all of a patch wide, and what noise
// elements have is not blown up further. Without, a dome's surface is 1.9 instead of 1.3 % of the travel off, with the
// fields of the very place.
constexpr double kToNoWidth = 0.8;
// Shapes beyond those that are kept, which the random products need to find the kept ones.
constexpr Eigen::Index kSpare = 12;
// Shapes without which all fields together lose less than this share of their size are left out.
constexpr double kLost = 0.004;
// In deviations of the patch: within half of it a field is smoothed, less up to all of it; the paraboloid is fitted as
// far as kAround times it, to so many vertices or more that look the same way. Tori have 0.2 % less of the travel off
// with it.
constexpr double kCore = 2, kAround = 1.5, kFacing = 0.3;
constexpr Eigen::Index kFewestAround = 10;
// Images are 16 MB at most; beside its floats a vertex has 0.7 kB of triangles, boxes and normals.
constexpr std::size_t kMostFloats = 3'700'000, kBesideFloats = 170;
constexpr std::int32_t kFewestShapes = 8;

// What the soft modes alone do under a patch, of first and second order.
struct SoftAnswer {
  Eigen::VectorXd first, second;  // amplitudes for 1 N and 1 N^2
};
SoftAnswer soft_answer(const elastic::ElasticBody<3>& body, const Eigen::VectorXd& load) {
  const elastic::SoftPotential& v = body.maps.potential;
  const Eigen::Index s = body.soft;
  SoftAnswer soft;
  soft.first = (body.modes.phi_1pm.leftCols(s).transpose() * load).cwiseQuotient(v.lambda());
  const Eigen::VectorXd& q = soft.first;
  soft.second = Eigen::VectorXd::Zero(s);
  for (std::size_t m = 0; m < v.cubic_index().size(); ++m) {
    const auto& [a, b, c] = v.cubic_index()[m];
    const double of = v.cubic[static_cast<Eigen::Index>(m)];
    soft.second[a] -= of * q[b] * q[c];
    soft.second[b] -= of * q[a] * q[c];
    soft.second[c] -= of * q[a] * q[b];
  }
  for (int a = 0; a < s; ++a)
    for (int b = 0; b < s; ++b)
      soft.second[a] += load.dot(body.maps.theta_1pm3[elastic::pair_place(a, b, static_cast<int>(s))]) * q[b];
  soft.second = soft.second.cwiseQuotient(v.lambda());
  return soft;
}

// The directions that hold most of the columns of `fields`, by products with random vectors (Halko, Martinsson & Tropp
// 2011, algorithm 4.1), largest first; at most `most`, fewer where those lose nothing.
Eigen::MatrixXf main_directions(const Eigen::MatrixXf& fields, Eigen::Index most) {
  const Eigen::Index tried = std::min({most + kSpare, fields.rows(), fields.cols()});
  elastic::FixedRandom random(2);
  Eigen::MatrixXf mixed(fields.cols(), tried);
  for (Eigen::Index i = 0; i < mixed.size(); ++i) mixed.data()[i] = static_cast<float>(random.symmetric());
  const Eigen::MatrixXf product = fields * mixed;
  const Eigen::HouseholderQR<Eigen::MatrixXf> qr(product);
  const Eigen::MatrixXf basis = qr.householderQ() * Eigen::MatrixXf::Identity(fields.rows(), tried);
  const Eigen::MatrixXd inside = (basis.transpose() * fields).cast<double>();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(inside * inside.transpose());
  const double whole = static_cast<double>(fields.squaredNorm());
  Eigen::Index kept = 0;
  for (double held = 0; kept < std::min(most, tried) && whole - held > kLost * kLost * whole; ++kept)
    held += solver.eigenvalues()[tried - 1 - kept];
  return basis * solver.eigenvectors().rowwise().reverse().leftCols(std::max<Eigen::Index>(kept, 1)).cast<float>();
}

}  // namespace

DrawnFields::DrawnFields(const elastic::RestBody<3>& rest, const std::vector<FacetFoot>& feet,
                         std::span<const Vec3> vertex_m, std::span<const Vec3> vertex_normal, double depth_m)
    : rest_(rest),
      feet_(feet),
      vertex_m_(vertex_m.begin(), vertex_m.end()),
      vertex_normal_(vertex_normal.begin(), vertex_normal.end()),
      depth_m_(depth_m),
      reach_m_(drawn_shapes::reach_m(vertex_m)) {}

Eigen::VectorXd DrawnFields::at_vertices(const Eigen::VectorXd& field) const {
  Eigen::VectorXd shown(static_cast<Eigen::Index>(3 * feet_.size()));
  for (std::size_t v = 0; v < feet_.size(); ++v) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t a = 0; a < feet_[v].node.size(); ++a)
      sum += feet_[v].shape.value[a] * field.segment<3>(3 * feet_[v].node[a]);
    shown.segment<3>(static_cast<Eigen::Index>(3 * v)) = sum;
  }
  return shown;
}

Eigen::VectorXd DrawnFields::less_half_space(const elastic::PressedPlace& place, int patch) const {
  Eigen::VectorXd shown = at_vertices(place.u_mpN[patch]);
  const Vec3 at = vec(rest_.surface().rest(place.node)),
             inward = -vec(elastic::node_normal(rest_.surface(), place.node));
  const double modulus = rest_.contact_modulus(place.node), nu = rest_.material().poisson_ratio;
  for (std::size_t v = 0; v < vertex_m_.size(); ++v) {
    const Vec3 from = vertex_m_[v] - at;
    const double r = norm(from),
                 share = drawn_shapes::outlook(vertex_normal_[v], inward) * drawn_shapes::near(r, reach_m_);
    if (!(share > 0)) continue;
    const elastic::PatchAnswer half = elastic::gaussian_patch_answer(r, place.sigma_m[patch], modulus, nu);
    const Vec3 u = share * (half.inward_mpN * inward + half.outward_mpN * unit_or(tangential_part(from, inward), {}));
    shown.segment<3>(static_cast<Eigen::Index>(3 * v)) -= Eigen::Vector3d(u.x, u.y, u.z);
  }
  return shown;
}

// Under the patch itself elements of its size tell little but noise, other at every place: there a paraboloid through
// what is around it.
void DrawnFields::smooth_core(const elastic::PressedPlace& place, Eigen::VectorXd& field) const {
  const Vec3 at = vec(rest_.surface().rest(place.node)), up = vec(elastic::node_normal(rest_.surface(), place.node));
  const Vec3 one = unit_or(cross(up, axis_off(up)), {1, 0, 0}), two = cross(up, one);
  const double unit_m = kCore * place.sigma_m[0];
  std::vector<Eigen::Index> near;
  std::vector<double> share;
  Eigen::MatrixXd power(static_cast<Eigen::Index>(vertex_m_.size()), 6);
  for (std::size_t v = 0; v < vertex_m_.size(); ++v) {
    const Vec3 from = (1 / unit_m) * (vertex_m_[v] - at);
    const double r = norm(from);
    if (!(r < kAround) || !(dot(vertex_normal_[v], up) > kFacing)) continue;
    const double x = dot(from, one), y = dot(from, two);
    power.row(static_cast<Eigen::Index>(near.size())) << 1, x, y, x * x, x * y, y * y;
    near.push_back(static_cast<Eigen::Index>(v));
    share.push_back(drawn_shapes::near(r, 1));
  }
  const auto n = static_cast<Eigen::Index>(near.size());
  if (n < kFewestAround) return;
  Eigen::MatrixXd value(n, 3);
  for (Eigen::Index i = 0; i < n; ++i)
    value.row(i) = field.segment<3>(3 * near[static_cast<std::size_t>(i)]).transpose();
  const Eigen::MatrixXd smooth = power.topRows(n) * power.topRows(n).colPivHouseholderQr().solve(value);
  for (Eigen::Index i = 0; i < n; ++i)
    field.segment<3>(3 * near[static_cast<std::size_t>(i)]) +=
        share[static_cast<std::size_t>(i)] * (smooth.row(i) - value.row(i)).transpose();
}

void DrawnFields::add(const elastic::PressedPlace& place) {
  Place kept;
  kept.node = place.node;
  std::copy_n(place.sigma_m, 2, kept.sigma_m);
  kept.force_N = depth_m_ / place.give_mpN;
  const Eigen::VectorXd narrow = less_half_space(place, 0), wide = less_half_space(place, 1);
  const double ratio = place.sigma_m[1] / place.sigma_m[0];
  Eigen::VectorXd first = narrow + kToNoWidth / (ratio * ratio - 1) * (narrow - wide),
                  second = at_vertices(place.second_mpN2);
  first += (1 - kToNoWidth) * at_vertices(place.bent_mpN);  // it grows as the square of the width
  smooth_core(place, first);
  smooth_core(place, second);
  kept.first_mpN = first.cast<float>();
  kept.second_mpN2 = second.cast<float>();
  place_.push_back(std::move(kept));
}

// Of all places first and second order, each by the force that presses deepest there.
Eigen::MatrixXf DrawnFields::fields(const elastic::ElasticBody<3>& body) const {
  const int s = body.soft;
  Eigen::MatrixXd mode(static_cast<Eigen::Index>(3 * feet_.size()), s), pair(mode.rows(), elastic_layout::pairs(s));
  for (int a = 0; a < s; ++a) {
    mode.col(a) = at_vertices(body.modes.phi_1pm.col(a));
    for (int b = a; b < s; ++b) {
      const auto i = static_cast<Eigen::Index>(elastic::pair_place(a, b, s));
      pair.col(i) = at_vertices(body.maps.theta_1pm3[elastic::pair_place(a, b, s)]);
    }
  }
  Eigen::MatrixXf all(mode.rows(), static_cast<Eigen::Index>(2 * place_.size()));
  for (std::size_t p = 0; p < place_.size(); ++p) {
    const Place& place = place_[p];
    const Vector<3> at = rest_.surface().rest(place.node), normal = elastic::node_normal(rest_.surface(), place.node);
    const SoftAnswer soft = soft_answer(body, elastic::gaussian_patch<3>(rest_, at, normal, place.sigma_m[0]));
    Eigen::VectorXd product(pair.cols());
    for (int a = 0; a < s; ++a)
      for (int b = a; b < s; ++b)
        product[static_cast<Eigen::Index>(elastic::pair_place(a, b, s))] =
            (a == b ? 0.5 : 1) * soft.first[a] * soft.first[b];
    const auto column = static_cast<Eigen::Index>(2 * p);
    const double f = place.force_N;
    all.col(column) = (f * (place.first_mpN.cast<double>() - mode * soft.first)).cast<float>();
    all.col(column + 1) =
        (f * f * (place.second_mpN2.cast<double>() - mode * soft.second - pair * product)).cast<float>();
  }
  return all;
}

void DrawnFields::append(const elastic::ElasticBody<3>& body, double spacing_m, std::vector<float>& floats) const {
  const Eigen::MatrixXf all = fields(body);
  const auto vertices = vertex_m_.size();
  const auto linear = static_cast<std::int32_t>(body.modes.lambda_Npm3.size()) - body.soft;
  const std::size_t used =
      vertices * (static_cast<std::size_t>(elastic_layout::vertex_floats(body.soft, linear)) + kBesideFloats);
  const std::size_t room = used < kMostFloats ? (kMostFloats - used) / (vertices * elastic_layout::kDrawnFloats) : 0;
  const auto most =
      std::max(static_cast<std::int32_t>(std::min<std::size_t>(room, elastic_layout::kMostDrawnShapes)), kFewestShapes);
  const Eigen::MatrixXf shape = main_directions(all, most);
  const Eigen::MatrixXd share = (shape.transpose() * all).cast<double>();
  const Eigen::Index count = shape.cols();
  Eigen::MatrixXd value(static_cast<Eigen::Index>(place_.size()), 2 * count);
  std::vector<int> nodes;
  for (std::size_t p = 0; p < place_.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    const double f = place_[p].force_N;
    value.row(row) << share.col(2 * row).transpose() / f, share.col(2 * row + 1).transpose() / (f * f);
    nodes.push_back(place_[p].node);
  }
  const SampleField anywhere(rest_.surface(), nodes, value, spacing_m);
  floats.push_back(static_cast<float>(count));
  for (std::size_t v = 0; v < vertices; ++v) {
    const Eigen::RowVectorXd own = anywhere.show(vertex_m_[v], vertex_normal_[v]);
    for (Eigen::Index k = 0; k < count; ++k) {
      for (Eigen::Index i = 0; i < 3; ++i) floats.push_back(shape(static_cast<Eigen::Index>(3 * v) + i, k));
      floats.push_back(static_cast<float>(own[k]));
      floats.push_back(static_cast<float>(own[count + k]));
    }
  }
}

}  // namespace palpate
