#include "config/elastic/surface_modes.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>

#include "config/elastic/fixed_random.h"
#include "config/scene/config_error.h"

namespace palpate::elastic {

namespace {

// A block finds symmetric families of up to so many equal modes; single vectors would meet the second of a pair only
// by rounding.
constexpr Eigen::Index kBlock = 4;
// Residual |K^-1 M_s phi - phi / lambda|, share of phi / lambda.
constexpr double kModeTolerance = 1e-9;
constexpr int kMaxBlocks = 200;
// Modes closer than this share of lambda are one family.
constexpr double kFamilyShare = 0.01;

// An M_s-orthonormal basis that grows by blocks, with the images K^-1 M_s v of its vectors.
template <int kDim>
class KrylovBasis {
 public:
  explicit KrylovBasis(const RestBody<kDim>& body) : body_(body) {}

  // Nothing when the vector lies in the span already. Its image waits for solve().
  void add(Eigen::VectorXd v) {
    const double before = std::sqrt(std::max(0.0, v.dot(body_.surface().mass_times(v))));
    for (int pass = 0; pass < 2; ++pass)  // twice is enough (Kahan, in Parlett 1980)
      for (std::size_t i = 0; i < vector_.size(); ++i) v -= weighted_[i].dot(v) * vector_[i];
    Eigen::VectorXd weighted = body_.surface().mass_times(v);
    const double norm = std::sqrt(std::max(0.0, v.dot(weighted)));
    if (!(norm > 1e-10 * before)) return;
    vector_.push_back(v / norm);
    body_.release_fixed(weighted);
    weighted_.push_back(weighted / norm);
  }
  // The images that are missing, together: a solve spends its time on fetching the factor.
  void solve() {
    const std::size_t first = image_.size();
    if (first == size()) return;  // exhausted
    Eigen::MatrixXd load(body_.size(), static_cast<Eigen::Index>(size() - first));
    for (std::size_t i = first; i < size(); ++i) load.col(static_cast<Eigen::Index>(i - first)) = weighted_[i];
    const Eigen::MatrixXd images = body_.solve_all(load);
    for (Eigen::Index i = 0; i < images.cols(); ++i) image_.emplace_back(images.col(i));
  }
  std::size_t size() const { return vector_.size(); }
  const Eigen::VectorXd& image(std::size_t i) const { return image_[i]; }

  // Ritz pairs of K^-1 M_s, largest value (softest mode) first.
  struct Ritz {
    Eigen::VectorXd value;
    Eigen::MatrixXd combination;
  };
  Ritz ritz() const {
    const auto n = static_cast<Eigen::Index>(size());
    Eigen::MatrixXd projected(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j)
        projected(i, j) = projected(j, i) =
            weighted_[static_cast<std::size_t>(j)].dot(image_[static_cast<std::size_t>(i)]);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(projected);
    return {solver.eigenvalues().reverse(), solver.eigenvectors().rowwise().reverse()};
  }
  Eigen::VectorXd combine(const std::vector<Eigen::VectorXd>& of, const Eigen::VectorXd& weights) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(body_.size());
    for (std::size_t i = 0; i < of.size(); ++i) sum += weights[static_cast<Eigen::Index>(i)] * of[i];
    return sum;
  }
  Eigen::VectorXd vector(const Eigen::VectorXd& weights) const { return combine(vector_, weights); }
  Eigen::VectorXd image(const Eigen::VectorXd& weights) const { return combine(image_, weights); }

 private:
  const RestBody<kDim>& body_;
  std::vector<Eigen::VectorXd> vector_, weighted_, image_;  // v, M_s v, K^-1 M_s v
};

// The first component that comes within a tenth of the largest decides: a symmetric mode has several of equal size,
// and rounding must not choose.
void fix_sign(Eigen::Ref<Eigen::VectorXd> mode) {
  const double largest = mode.cwiseAbs().maxCoeff();
  Eigen::Index i = 0;
  while (std::abs(mode[i]) < 0.9 * largest) ++i;
  if (mode[i] < 0) mode = -mode;
}

}  // namespace

template <int kDim>
SurfaceModes surface_modes(const RestBody<kDim>& body, int count) {
  KrylovBasis<kDim> basis(body);
  FixedRandom random(1);
  for (Eigen::Index b = 0; b < kBlock; ++b) {
    Eigen::VectorXd load(body.size());
    for (double& x : load) x = random.symmetric();
    body.release_fixed(load);
    basis.add(body.solve(load));
  }
  basis.solve();
  SurfaceModes modes;
  std::size_t done = 0;
  for (int block = 1; block < kMaxBlocks; ++block) {
    const std::size_t end = basis.size();
    for (; done < end; ++done) basis.add(basis.image(done));
    basis.solve();
    const bool exhausted = basis.size() == end;
    if (!exhausted && (basis.size() < static_cast<std::size_t>(2 * count) || block % 4 != 0)) continue;
    const auto ritz = basis.ritz();
    if (ritz.value.size() < count || !(ritz.value[count - 1] > 0)) break;
    bool settled = true;
    for (int m = count; m-- > 0 && settled;) {
      const Eigen::VectorXd weights = ritz.combination.col(m), v = basis.vector(weights);
      const Eigen::VectorXd off = basis.image(weights) - ritz.value[m] * v;
      settled = std::sqrt(std::max(0.0, off.dot(body.surface().mass_times(off)))) < kModeTolerance * ritz.value[m];
    }
    if (!settled && !exhausted) continue;
    modes.lambda_Npm3 = ritz.value.head(count).cwiseInverse();
    modes.phi_1pm.resize(body.size(), count);
    for (int m = 0; m < count; ++m) {
      modes.phi_1pm.col(m) = basis.vector(ritz.combination.col(m));
      fix_sign(modes.phi_1pm.col(m));
    }
    return modes;
  }
  throw ConfigError("elastic body: fewer than " + std::to_string(count) +
                    " modes of the surface were found; ask for fewer or refine the mesh");
}

template SurfaceModes surface_modes<2>(const RestBody<2>&, int);
template SurfaceModes surface_modes<3>(const RestBody<3>&, int);

int whole_families(const SurfaceModes& modes, int wanted) {
  const auto& l = modes.lambda_Npm3;
  while (wanted > 0 && wanted < l.size() && l[wanted] < (1 + kFamilyShare) * l[wanted - 1]) ++wanted;
  return wanted;
}

}  // namespace palpate::elastic
