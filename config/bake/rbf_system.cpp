#include "config/bake/rbf_system.h"

#include <utility>

namespace palpate {
namespace {

// Pivots below this are zero to working precision in the scaled system, whose entries are of order one.
constexpr Real kSingularPivot = 1e-9;

struct Frame {
  Vec3 centre_m;
  Real scale_m = 0;
};

bool bounding_frame(std::span<const Vec3> anchors, Frame& frame) noexcept {
  Vec3 sum;
  for (const Vec3& a : anchors) {
    if (!is_finite(a)) return false;
    sum += a;
  }
  frame.centre_m = (1.0 / static_cast<Real>(anchors.size())) * sum;
  for (const Vec3& a : anchors) frame.scale_m = max_of(frame.scale_m, norm(a - frame.centre_m));
  // One anchor, or several in one place (which the pivots then find): any scale will do.
  if (!(frame.scale_m > 0)) frame.scale_m = 1;
  return true;
}

using Matrix = Real[kMaxRbf][kMaxRbf];

// The scaled system, y = (x - centre) / scale.
void fill_system(std::span<const Vec3> anchors, const Frame& frame, bool linear, Matrix& m) noexcept {
  const std::size_t count = anchors.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 y = (1.0 / frame.scale_m) * (anchors[i] - frame.centre_m);
    for (std::size_t j = 0; j < count; ++j) m[i][j] = norm(anchors[i] - anchors[j]) / frame.scale_m;
    const Real tail[4] = {1, y.x, y.y, y.z};
    for (std::size_t k = 0; k < (linear ? 4u : 1u); ++k) m[i][count + k] = m[count + k][i] = tail[k];
  }
}

// Gauss-Jordan with partial pivoting, m -> identity, inverse -> m^-1. The matrix is indefinite, so no Cholesky.
bool invert(Matrix& m, Matrix& inverse, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) inverse[i][i] = 1;
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t i = column + 1; i < n; ++i) {
      if (abs_of(m[i][column]) > abs_of(m[pivot][column])) pivot = i;
    }
    if (!(abs_of(m[pivot][column]) > kSingularPivot)) return false;
    for (std::size_t j = 0; j < n; ++j) {
      std::swap(m[pivot][j], m[column][j]);
      std::swap(inverse[pivot][j], inverse[column][j]);
    }
    const Real scale = 1.0 / m[column][column];
    for (std::size_t j = 0; j < n; ++j) {
      m[column][j] *= scale;
      inverse[column][j] *= scale;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Real factor = m[i][column];
      if (i == column || factor == 0) continue;
      for (std::size_t j = 0; j < n; ++j) {
        m[i][j] -= factor * m[column][j];
        inverse[i][j] -= factor * inverse[column][j];
      }
    }
  }
  return true;
}

// Back to metres. With M = D M_y D^T, D = diag(sqrt(L), Q^T / sqrt(L)) and [1 x] = [1 y] Q, the inverse is
// D^-T B_y D^-1: the upper block divided by L, the border multiplied by Q^-1, the corner by L Q^-1 (.) Q^-T.
void undo_scaling(const Frame& frame, bool linear, std::size_t count, const Matrix& scaled,
                  std::span<double> inverse) noexcept {
  const std::size_t tail = linear ? 4 : 1;
  const std::size_t n = count + tail;
  const Real l = frame.scale_m;
  const Real c[3] = {frame.centre_m.x, frame.centre_m.y, frame.centre_m.z};
  Real q[4][4] = {{1, -c[0] / l, -c[1] / l, -c[2] / l}, {0, 1 / l, 0, 0}, {0, 0, 1 / l, 0}, {0, 0, 0, 1 / l}};
  const auto put = [&](std::size_t i, std::size_t j, Real value) { inverse[i * n + j] = inverse[j * n + i] = value; };
  const auto b = [&](std::size_t i, std::size_t j) { return 0.5 * (scaled[i][j] + scaled[j][i]); };
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= i; ++j) put(i, j, b(i, j) / l);
    for (std::size_t r = 0; r < tail; ++r) {
      Real sum = 0;
      for (std::size_t k = 0; k < tail; ++k) sum += q[r][k] * b(count + k, i);
      put(count + r, i, sum);
    }
  }
  for (std::size_t r = 0; r < tail; ++r) {
    for (std::size_t s = 0; s <= r; ++s) {
      Real sum = 0;
      for (std::size_t k = 0; k < tail; ++k) {
        for (std::size_t m = 0; m < tail; ++m) sum += q[r][k] * q[s][m] * b(count + k, count + m);
      }
      put(count + r, count + s, sum * l);
    }
  }
}

}  // namespace

bool invert_rbf_system(std::span<const Vec3> anchors, RbfTail tail, std::span<double> inverse) noexcept {
  const std::size_t count = anchors.size();
  const std::size_t n = count + static_cast<std::size_t>(rbf_tail_size(tail));
  if (count == 0 || count > static_cast<std::size_t>(kMaxAnchors) || inverse.size() < n * n) return false;
  Frame frame;
  if (!bounding_frame(anchors, frame)) return false;
  Matrix system{};
  Matrix scaled{};
  fill_system(anchors, frame, tail == RbfTail::kLinear, system);
  if (!invert(system, scaled, n)) return false;
  undo_scaling(frame, tail == RbfTail::kLinear, count, scaled, inverse);
  return true;
}

}  // namespace palpate
