#include "config/fem/material.h"

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "config/index.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

using Motion = Eigen::Matrix<double, 6, 1>;  // rotation about the centre x, y, z (times the size), translation x, y, z
using Motions = Eigen::Matrix<double, Eigen::Dynamic, 6>;

// Nodes of each connected part of the mesh.
std::vector<std::vector<std::int32_t>> parts_of(const TetMesh& mesh) {
  std::vector<std::int32_t> root(mesh.node_m.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::int32_t i) {
    while (root[at(i)] != i) i = root[at(i)] = root[at(root[at(i)])];
    return i;
  };
  for (const Tet& tet : mesh.tet)
    for (std::size_t k = 1; k < 10; ++k)
      if (tet.node[k] >= 0) root[at(find(tet.node[k]))] = find(tet.node[0]);
  std::vector<std::vector<std::int32_t>> by_root(mesh.node_m.size()), parts;
  for (std::size_t i = 0; i < root.size(); ++i)
    by_root[at(find(static_cast<std::int32_t>(i)))].push_back(static_cast<std::int32_t>(i));
  for (std::vector<std::int32_t>& part : by_root)
    if (!part.empty()) parts.push_back(std::move(part));
  return parts;
}

struct Frame {
  Vec3 centre_m;
  double size_m = 0;
};

Frame frame_of(const TetMesh& mesh, const std::vector<std::int32_t>& nodes) {
  Frame frame;
  for (const std::int32_t i : nodes) frame.centre_m += (1.0 / static_cast<double>(nodes.size())) * mesh.node_m[at(i)];
  for (const std::int32_t i : nodes) frame.size_m = std::max(frame.size_m, norm(mesh.node_m[at(i)] - frame.centre_m));
  return frame;
}

// Rigid motions that move no held component: rows, reduced so that they follow the axes where they can.
Motions free_motions(const TetMesh& mesh, const Supports& supports, const std::vector<std::int32_t>& nodes,
                     const Frame& frame) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  for (const std::int32_t i : nodes)
    for (std::size_t a = 0; a < 3; ++a) {
      if ((supports[at(i)] >> a & 1) == 0) continue;
      const Vec3 r = (1.0 / frame.size_m) * (mesh.node_m[at(i)] - frame.centre_m);
      // Component a of w x r + t.
      const double rotation[3][3] = {{0, r.z, -r.y}, {-r.z, 0, r.x}, {r.y, -r.x, 0}};
      Motion row = Motion::Zero();
      for (std::size_t k = 0; k < 3; ++k) row(static_cast<Eigen::Index>(k)) = rotation[a][k];
      row(static_cast<Eigen::Index>(3 + a)) = 1;
      normal += row * row.transpose();
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(normal);
  // Squares of singular values: 1e-14 is a lever of 1e-7 of the body's size, on a scale where one held node gives 1.
  const auto count = (eigen.eigenvalues().array() < 1e-14).count();
  Motions motions = eigen.eigenvectors().leftCols(count).transpose();
  Eigen::Index row = 0;
  for (Eigen::Index column = 0; column < 6 && row < motions.rows(); ++column) {
    Eigen::Index pivot = 0;
    if (motions.col(column).tail(motions.rows() - row).cwiseAbs().maxCoeff(&pivot) < 1e-6) continue;
    motions.row(row).swap(motions.row(row + pivot));
    motions.row(row) /= double{motions(row, column)};
    for (Eigen::Index other = 0; other < motions.rows(); ++other)
      if (other != row) motions.row(other) -= double{motions(other, column)} * motions.row(row).eval();
    ++row;
  }
  return motions;
}

// Rounding left by the elimination is not worth reading.
Vec3 without_dust(Vec3 p, double size) {
  for (double* c : {&p.x, &p.y, &p.z})
    if (std::abs(*c) < 1e-9 * size) *c = 0;
  return p;
}

std::string direction_text(Vec3 d) {
  const Vec3 u = without_dust(unit_or(d, {}), 1);
  const double components[3] = {u.x, u.y, u.z};
  for (int k = 0; k < 3; ++k)
    if (std::abs(std::abs(components[k]) - 1.0) < 1e-6) return std::string(1, "xyz"[k]);
  char text[64];
  std::snprintf(text, sizeof text, "(%.3g, %.3g, %.3g)", u.x, u.y, u.z);
  return text;
}

std::string motion_text(const Motion& m, const Frame& frame) {
  const Vec3 turn{m(0), m(1), m(2)}, slide{m(3), m(4), m(5)};
  if (norm(turn) < 1e-5) return "slide along " + direction_text(slide);
  const Vec3 through_m =
      without_dust(frame.centre_m + (frame.size_m / squared_norm(turn)) * cross(turn, slide), frame.size_m);
  char text[128];
  std::snprintf(text, sizeof text, " through (%.4g, %.4g, %.4g) mm", 1e3 * through_m.x, 1e3 * through_m.y,
                1e3 * through_m.z);
  return "turn about an axis along " + direction_text(turn) + text;
}

}  // namespace

void check_material(const FemMaterial& material, const std::string& label) {
  char text[160];
  if (!(material.young_Pa > 0 && material.young_Pa < kHuge)) {
    std::snprintf(text, sizeof text, ": Young's modulus is %.6g Pa; it must be positive and finite", material.young_Pa);
    throw ConfigError(label + text);
  }
  if (!(material.poisson > -1.0 && material.poisson < 0.5)) {
    std::snprintf(text, sizeof text,
                  ": Poisson's ratio is %.6g; allowed -1 to 0.5, both excluded (0.4999 for incompressible rubber)",
                  material.poisson);
    throw ConfigError(label + text);
  }
}

Supports hold_where(const TetMesh& mesh, const std::function<bool(Vec3)>& held) {
  Supports supports(mesh.node_m.size(), 0);
  for (std::size_t i = 0; i < supports.size(); ++i)
    if (held(mesh.node_m[i])) supports[i] = kHoldAll;
  return supports;
}

void check_supports(const TetMesh& mesh, const Supports& supports, const std::string& label) {
  if (supports.size() != mesh.node_m.size())
    throw ConfigError(label + ": supports are given for " + std::to_string(supports.size()) + " nodes of " +
                      std::to_string(mesh.node_m.size()));
  const auto parts = parts_of(mesh);
  for (const std::vector<std::int32_t>& part : parts) {
    const Frame frame = frame_of(mesh, part);
    const Motions motions = free_motions(mesh, supports, part, frame);
    if (motions.rows() == 0) continue;
    std::string text = label + ": nothing keeps the body from moving as a whole: it can ";
    for (Eigen::Index i = 0; i < motions.rows(); ++i)
      text += (i == 0 ? "" : i + 1 == motions.rows() ? " and " : ", ") + motion_text(motions.row(i).transpose(), frame);
    if (parts.size() > 1)
      text += " (the part of " + std::to_string(part.size()) + " nodes around node " + std::to_string(part[0]) + ")";
    throw ConfigError(text + "; hold at least three nodes that do not lie on one line");
  }
}

}  // namespace palpate
