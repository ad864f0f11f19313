#include "tests/peers/gauss_seidel_peer.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "rt_core/tool/shapes.h"

namespace palpate::peers {

namespace {

constexpr int kMostSweeps = 2000;
constexpr double kGap_m = 1e-9;  // the largest violation left: a tenth of a millinewton on a stiff node

struct Candidate {
  std::size_t node;
  Vec3 normal;  // from the tool into the body
  double gap_m;
};

}  // namespace

GaussSeidelPeer::GaussSeidelPeer(const Model& model) : model_(model), last_N_(model.vertex_m.size(), 0.0) {}

double GaussSeidelPeer::compliance(std::size_t row, std::size_t column) const {
  const std::size_t at = row * 3 * model_.vertex_m.size() + column;
  return model_.compliance_f64.empty() ? double{model_.compliance_f32[at]} : model_.compliance_f64[at];
}

Vec3 GaussSeidelPeer::force_N(std::span<const Pose> piece_w) {
  std::vector<Candidate> near;
  for (std::size_t node = 0; node < model_.vertex_m.size(); ++node) {
    for (std::size_t i = 0; i < piece_w.size(); ++i) {
      const ToolPiece& piece = model_.piece[i];
      const Pose& at = piece_w[i];
      const Vec3 from = model_.vertex_m[node] - at.position_m;
      if (dot(from, from) > piece.bounding_radius_m * piece.bounding_radius_m * 1.21) continue;
      const PieceGap gap = piece_gap(piece, rotate(conjugate(at.orientation), from));
      if (gap.gap_m > model_.params.contact_margin_m) continue;
      near.push_back({node, rotate(at.orientation, gap.normal), gap.gap_m});
      break;
    }
  }
  const auto n = static_cast<Eigen::Index>(near.size());
  candidates_ = static_cast<int>(n);
  Eigen::MatrixXd a(n, n);
  Eigen::VectorXd f(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Candidate& row = near[static_cast<std::size_t>(i)];
    f[i] = last_N_[row.node];
    for (Eigen::Index j = 0; j < n; ++j) {
      const Candidate& column = near[static_cast<std::size_t>(j)];
      const double u[3] = {row.normal.x, row.normal.y, row.normal.z},
                   v[3] = {column.normal.x, column.normal.y, column.normal.z};
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = 0; l < 3; ++l) sum += u[k] * compliance(3 * row.node + k, 3 * column.node + l) * v[l];
      a(i, j) = sum;
    }
  }
  for (sweeps_ = 0; sweeps_ < kMostSweeps; ++sweeps_) {
    double worst_m = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!(a(i, i) > 0)) continue;  // a node that is held
      const double left_m = near[static_cast<std::size_t>(i)].gap_m + a.row(i).dot(f);
      const double next_N = std::max(0.0, f[i] - left_m / a(i, i));
      worst_m = std::max(worst_m, std::fabs(next_N - f[i]) * a(i, i));
      f[i] = next_N;
    }
    if (worst_m < kGap_m) break;
  }
  std::fill(last_N_.begin(), last_N_.end(), 0.0);
  Vec3 force;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Candidate& at = near[static_cast<std::size_t>(i)];
    last_N_[at.node] = f[i];
    force += f[i] * at.normal;
  }
  return force;
}

}  // namespace palpate::peers
