#include "config/fem/linear_body.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/fem/fill_order.h"
#include "config/fem/sparse_factor.h"
#include "config/fem/tet_element.h"
#include "config/index.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Triplet = Eigen::Triplet<double>;

void check_order(const TetMesh& mesh, const FemMaterial& material, const std::string& label) {
  if (material.poisson <= kMeanDilatationAbove) return;
  for (std::size_t t = 0; t < mesh.tet.size(); ++t)
    if (!mesh.tet[t].is_quadratic())
      throw ConfigError(label + ": tetrahedron " + std::to_string(t) + " is linear, and Poisson's ratio is above " +
                        std::to_string(kMeanDilatationAbove) +
                        ": linear elements lock (a beam bends by half of what it should); make all elements quadratic");
}

// Whole stiffness, three equations per node, both triangles.
Matrix assemble(const TetMesh& mesh, const FemMaterial& material, const Progress& progress) {
  std::vector<Triplet> entries;
  for (std::size_t t = 0; t < mesh.tet.size(); ++t) {
    if (progress && t % 256 == 0) progress("stiffness", static_cast<double>(t) / static_cast<double>(mesh.tet.size()));
    const Tet& tet = mesh.tet[t];
    const TetStiffness k = tet_stiffness(mesh, tet, material);
    for (int i = 0; i < 30; ++i)
      for (int j = 0; j < 30; ++j) {
        const std::int32_t a = tet.node[static_cast<std::size_t>(i / 3)], b = tet.node[static_cast<std::size_t>(j / 3)];
        if (a >= 0 && b >= 0) entries.emplace_back(3 * a + i % 3, 3 * b + j % 3, k(i, j));
      }
  }
  if (progress) progress("stiffness", 1);
  const auto n = static_cast<Eigen::Index>(3 * mesh.node_m.size());
  Matrix stiffness(n, n);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return stiffness;
}

// Elimination order of the nodes, on their graph.
std::vector<std::int32_t> node_order(const TetMesh& mesh) {
  std::vector<Triplet> entries;
  for (const Tet& tet : mesh.tet)
    for (const std::int32_t a : tet.node)
      for (const std::int32_t b : tet.node)
        if (a >= 0 && b >= 0) entries.emplace_back(a, b, 1.0);
  const auto n = static_cast<Eigen::Index>(mesh.node_m.size());
  Matrix graph(n, n);
  graph.setFromTriplets(entries.begin(), entries.end());
  return fem::minimum_degree(graph);
}

}  // namespace

struct LinearBody::System {
  Matrix stiffness;                    // of all components of all nodes
  std::vector<std::int32_t> equation;  // of component 3 node + axis in elimination order; -1: held
  std::size_t free_count = 0;
  std::unique_ptr<SparseFactor> factor;

  void number(const TetMesh& mesh, const Supports& supports) {
    equation.assign(3 * mesh.node_m.size(), -1);
    std::int32_t next = 0;
    for (const std::int32_t node : node_order(mesh))
      for (std::size_t a = 0; a < 3; ++a)
        if ((supports[at(node)] >> a & 1) == 0) equation[3 * at(node) + a] = next++;
    free_count = static_cast<std::size_t>(next);
  }
  Matrix lower_triangle() const {
    std::vector<Triplet> entries;
    for (Eigen::Index column = 0; column < stiffness.cols(); ++column)
      for (Matrix::InnerIterator entry(stiffness, column); entry; ++entry) {
        const std::int32_t i = equation[static_cast<std::size_t>(entry.row())];
        const std::int32_t j = equation[static_cast<std::size_t>(column)];
        if (i >= j && j >= 0) entries.emplace_back(i, j, entry.value());
      }
    const auto n = static_cast<Eigen::Index>(free_count);
    Matrix lower(n, n);
    lower.setFromTriplets(entries.begin(), entries.end());
    return lower;
  }
  std::vector<double> times(const std::vector<double>& u) const {
    std::vector<double> f(u.size(), 0.0);
    for (Eigen::Index column = 0; column < stiffness.cols(); ++column)
      for (Matrix::InnerIterator entry(stiffness, column); entry; ++entry)
        f[static_cast<std::size_t>(entry.row())] += entry.value() * u[static_cast<std::size_t>(column)];
    return f;
  }
};

namespace {

std::vector<double> flat(const std::vector<Vec3>& v) {
  std::vector<double> out;
  out.reserve(3 * v.size());
  for (const Vec3 p : v) out.insert(out.end(), {p.x, p.y, p.z});
  return out;
}
std::vector<Vec3> points(const std::vector<double>& v) {
  std::vector<Vec3> out(v.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2]};
  return out;
}

}  // namespace

LinearBody::LinearBody(const TetMesh& mesh, const FemMaterial& material, const Supports& supports,
                       const std::string& label, const Progress& progress)
    : system_(std::make_unique<System>()) {
  check_material(material, label);
  check_order(mesh, material, label);
  check_supports(mesh, supports, label);
  system_->stiffness = assemble(mesh, material, progress);
  if (progress) progress("factor", 0);
  system_->number(mesh, supports);
  try {
    system_->factor = std::make_unique<SparseFactor>(system_->lower_triangle());
  } catch (const ConfigError& error) {
    throw ConfigError(label + ": " + error.what());
  }
  if (progress) progress("factor", 1);
}
LinearBody::~LinearBody() = default;
LinearBody::LinearBody(LinearBody&&) noexcept = default;
LinearBody& LinearBody::operator=(LinearBody&&) noexcept = default;

std::vector<Vec3> LinearBody::solve_m(const std::vector<Vec3>& force_N) const {
  return solve_m(force_N, std::vector<Vec3>(force_N.size()));
}

std::vector<Vec3> LinearBody::solve_m(const std::vector<Vec3>& force_N, const std::vector<Vec3>& held_m) const {
  std::vector<double> u = flat(held_m), f = flat(force_N);
  for (std::size_t i = 0; i < u.size(); ++i)
    if (system_->equation[i] >= 0) u[i] = 0;
  const std::vector<double> by_supports = system_->times(u);
  std::vector<SparseFactor::Lane> x(system_->free_count);
  for (std::size_t i = 0; i < u.size(); ++i)
    if (system_->equation[i] >= 0) x[at(system_->equation[i])].value[0] = f[i] - by_supports[i];
  system_->factor->solve_from(0, x);
  for (std::size_t i = 0; i < u.size(); ++i)
    if (system_->equation[i] >= 0) u[i] = x[at(system_->equation[i])].value[0];
  return points(u);
}

std::vector<std::vector<Vec3>> LinearBody::solve_all_m(const std::vector<std::vector<Vec3>>& forces_N) const {
  constexpr std::size_t kWidth = SparseFactor::kWidth;
  const std::vector<std::int32_t>& equation = system_->equation;
  std::vector<std::vector<Vec3>> out;
  std::vector<SparseFactor::Lane> x(system_->free_count);
  for (std::size_t block = 0; block < forces_N.size(); block += kWidth) {
    const std::size_t end = std::min(block + kWidth, forces_N.size());
    std::fill(x.begin(), x.end(), SparseFactor::Lane{});
    for (std::size_t c = block; c < end; ++c) {
      const std::vector<double> f = flat(forces_N[c]);
      for (std::size_t i = 0; i < f.size(); ++i)
        if (equation[i] >= 0) x[at(equation[i])].value[c - block] = f[i];
    }
    system_->factor->solve_from(0, x);
    for (std::size_t c = block; c < end; ++c) {
      std::vector<double> u(equation.size(), 0.0);
      for (std::size_t i = 0; i < u.size(); ++i)
        if (equation[i] >= 0) u[i] = x[at(equation[i])].value[c - block];
      out.push_back(points(u));
    }
  }
  return out;
}

std::vector<Vec3> LinearBody::forces_N(const std::vector<Vec3>& displacement_m) const {
  return points(system_->times(flat(displacement_m)));
}

double LinearBody::energy_J(const std::vector<Vec3>& displacement_m) const {
  const std::vector<double> u = flat(displacement_m), f = system_->times(u);
  double twice = 0;
  for (std::size_t i = 0; i < u.size(); ++i) twice += u[i] * f[i];
  return 0.5 * twice;
}

std::vector<double> LinearBody::compliance_mpN(const std::vector<std::int32_t>& nodes, const Progress& progress) const {
  constexpr std::size_t kWidth = SparseFactor::kWidth;
  const std::size_t size = 3 * nodes.size();
  std::vector<std::pair<std::size_t, std::size_t>> column;  // equation in elimination order, row of the result
  for (std::size_t i = 0; i < size; ++i)
    if (const std::int32_t e = system_->equation[3 * at(nodes[i / 3]) + i % 3]; e >= 0) column.emplace_back(at(e), i);
  std::sort(column.begin(), column.end());
  // By symmetry a column is needed only from its own equation on: forward and backward passes both start there.
  std::vector<double> compliance(size * size, 0.0);
  std::vector<SparseFactor::Lane> x(system_->free_count);
  for (std::size_t block = 0; block < column.size(); block += kWidth) {
    const std::size_t end = std::min(block + kWidth, column.size()), first = column[block].first;
    std::fill(x.begin() + static_cast<std::ptrdiff_t>(first), x.end(), SparseFactor::Lane{});
    for (std::size_t c = block; c < end; ++c) x[column[c].first].value[c - block] = 1;
    system_->factor->solve_from(first, x);
    for (std::size_t c = block; c < end; ++c)
      for (std::size_t r = c; r < column.size(); ++r)
        compliance[column[r].second * size + column[c].second] =
            compliance[column[c].second * size + column[r].second] = x[column[r].first].value[c - block];
    if (progress) progress("compliance", static_cast<double>(end) / static_cast<double>(column.size()));
  }
  return compliance;
}

std::size_t LinearBody::degrees_of_freedom() const { return system_->free_count; }
std::size_t LinearBody::factor_entries() const { return system_->factor->entries(); }

}  // namespace palpate
