#include "config/elastic/static_contact.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::elastic {

namespace {

constexpr int kNewtonSteps = 100, kSweeps = 200, kCuts = 25;
constexpr double kForceTolerance = 1e-13, kSlopeTolerance = 1e-6;
// Of the body's extent: displacement of a difference, and the longest step of a tool.
constexpr double kProbeOfExtent = 1e-6, kStepOfExtent = 0.01;
// Places so near may be pushed against the tool by another contact's linear modes.
constexpr double kReachOfExtent = 0.01;
// Where negative self terms would turn the travel back, it goes on with this share of the local law's slope.
constexpr double kLeastSlopeShare = 0.1;
// A face on a flat body has no curvature to meet: its patch ends where the body does.
constexpr double kLeastCurvatureOfExtent = 0.1;

// local(F) + c F + c1 F^2, followed up to `limit_N`.
struct OwnLaw {
  LocalLaw local;
  double c_mpN = 0, c1_mpN2 = 0;
  double limit_N = std::numeric_limits<double>::infinity();

  double slope(double f) const { return local.at(f).compliance_mpN + c_mpN + 2 * c1_mpN2 * f; }
  // Travel, slope and complementary energy; beyond the limit with the slope there.
  LocalLaw::State at(double force_N) const {
    const double f = std::min(force_N, limit_N), beyond = force_N - f;
    LocalLaw::State s = local.at(f);
    s.travel_m += c_mpN * f + c1_mpN2 * f * f;
    s.compliance_mpN += c_mpN + 2 * c1_mpN2 * f;
    s.work_J += 0.5 * c_mpN * f * f + c1_mpN2 * f * f * f / 3;
    if (!(beyond > 0)) return s;
    s.work_J += beyond * (s.travel_m + 0.5 * beyond * s.compliance_mpN);
    s.travel_m += beyond * s.compliance_mpN;
    return s;
  }
};

OwnLaw own_law(const LocalLaw& local, double c_mpN, double c1_mpN2) {
  OwnLaw law{local, c_mpN, c1_mpN2};
  if (!(std::min(c_mpN, c1_mpN2) < 0)) return law;
  // Rises of the local compliance end somewhere: doubling finds where the sum has sunk to its least share of it.
  const auto sunk = [&](double f) { return law.slope(f) < kLeastSlopeShare * law.local.at(f).compliance_mpN; };
  double low = 0, high = 1e-9;
  while (!sunk(high) && high < 1e12) {
    low = high;
    high *= 2;
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (sunk(middle) ? high : low) = middle;
  }
  law.limit_N = low;
  return law;
}

// The force of a travel, none below zero.
double force_of(const OwnLaw& law, double travel_m, double guess_N) {
  if (!(travel_m > 0)) return 0;
  double low = 0, high = std::max(guess_N, 1e-9);
  while (law.at(high).travel_m < travel_m && high < 1e15) {
    low = high;
    high *= 2;
  }
  double f = guess_N > low && guess_N < high ? guess_N : 0.5 * (low + high);
  for (int i = 0; i < 100 && high - low > kForceTolerance * high; ++i) {
    const LocalLaw::State s = law.at(f);
    (s.travel_m > travel_m ? high : low) = f;
    const double next = f - (s.travel_m - travel_m) / s.compliance_mpN, before = f;
    f = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(f - before) <= kForceTolerance * f) break;
  }
  return f;
}

}  // namespace

template <int kDim>
StaticContact<kDim>::StaticContact(const ElasticBody<kDim>& body, std::vector<fem::RigidTool> tools)
    : body_(body), finder_(body, std::move(tools)), q_(Eigen::VectorXd::Zero(body.soft)), probe_m2_(body.soft) {
  for (int a = 0; a < body.soft; ++a)
    probe_m2_[a] = kProbeOfExtent * body.self.length_m / body.modes.phi_1pm.col(a).cwiseAbs().maxCoeff();
  origin_m_.resize(finder_.tools().size());
}

template <int kDim>
LocalLaw StaticContact<kDim>::law(const ContactPlace<kDim>& place) const {
  const fem::RigidTool& tool = finder_.tools()[static_cast<std::size_t>(place.tool)];
  LocalLaw out;
  out.plane = kDim == 2;
  out.modulus = body_.rest->contact_modulus();
  out.tool_curvature_1pm = tool.shape == fem::RigidShape::kBall ? 1 / tool.radius_m : 0;
  const double least = kLeastCurvatureOfExtent / body_.self.length_m;
  out.body_curvature_1pm = std::max(place.body_curvature_1pm, least - 0.9 * out.tool_curvature_1pm);
  out.length_m = body_.self.length_m;
  return out;
}

template <int kDim>
Eigen::MatrixXd StaticContact<kDim>::compliance(const std::vector<ContactPlace<kDim>>& places) const {
  const auto n = static_cast<Eigen::Index>(places.size());
  const Eigen::Index s = body_.soft, linear = body_.modes.lambda_Npm3.size() - s;
  const Eigen::VectorXd lambda = body_.modes.lambda_Npm3.tail(linear);
  Eigen::MatrixXd c(n, n);
  for (Eigen::Index k = 0; k < n; ++k)
    for (Eigen::Index l = 0; l < n; ++l)
      c(k, l) = places[static_cast<std::size_t>(k)].linear.dot(
          places[static_cast<std::size_t>(l)].linear.cwiseQuotient(lambda));
  for (Eigen::Index k = 0; k < n; ++k) c(k, k) = places[static_cast<std::size_t>(k)].self_mpN;
  return c;
}

namespace {

// Forces of all places, Gauss-Seidel: one place after the other at the others' last forces.
template <int kDim>
Eigen::VectorXd balance(const std::vector<OwnLaw>& laws, const std::vector<ContactPlace<kDim>>& places,
                        const Eigen::MatrixXd& c) {
  const Eigen::Index n = c.rows();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double change = 0;
    for (Eigen::Index k = 0; k < n; ++k) {
      const std::size_t i = static_cast<std::size_t>(k);
      const double others = c.row(k).dot(force) - c(k, k) * force[k];
      const double next = force_of(laws[i], places[i].travel_m - others, force[k]);
      change = std::max(change, std::abs(next - force[k]));
      force[k] = next;
    }
    if (!(change > kForceTolerance * force.maxCoeff())) break;
  }
  return force;
}

}  // namespace

template <int kDim>
void StaticContact<kDim>::add_contacts(Trial& trial) const {
  StaticState<kDim>& state = trial.state;
  const auto n = static_cast<Eigen::Index>(state.places.size());
  if (n == 0) return;
  const Eigen::MatrixXd c = compliance(state.places);
  std::vector<OwnLaw> laws;
  for (const ContactPlace<kDim>& place : state.places)
    laws.push_back(own_law(law(place), place.self_mpN, place.second_mpN2));
  const Eigen::VectorXd force = balance(laws, state.places, c);
  std::vector<Eigen::Index> active;
  for (Eigen::Index k = 0; k < n; ++k)
    if (force[k] > 0) active.push_back(k);
  Eigen::MatrixXd slope = c(active, active);
  Eigen::MatrixXd pull(body_.soft, static_cast<Eigen::Index>(active.size()));
  state.energy_J -= 0.5 * (force.dot(c * force) - force.dot(c.diagonal().cwiseProduct(force)));
  for (std::size_t j = 0; j < active.size(); ++j) {
    const Eigen::Index k = active[j], jj = static_cast<Eigen::Index>(j);
    const std::size_t i = static_cast<std::size_t>(k);
    const ContactPlace<kDim>& place = state.places[i];
    const LocalLaw::State local = laws[i].at(force[k]);
    slope(jj, jj) = local.compliance_mpN;
    pull.col(jj) = place.pull;
    state.energy_J += force[k] * place.travel_m - local.work_J;
    // The place slides along both surfaces: of the gap's curvature only that of their sum in series is left.
    const double tool = laws[i].local.tool_curvature_1pm, body = std::max(0.0, laws[i].local.body_curvature_1pm);
    const double bend = tool + body > 0 ? tool * body / (tool + body) : 0;
    const Eigen::MatrixXd across = place.slide - place.normal * place.pull.transpose();
    trial.curvature += force[k] * (place.turn - bend * across.transpose() * across);
  }
  if (!active.empty()) trial.curvature += pull * slope.inverse() * pull.transpose();
  state.force_N.assign(force.data(), force.data() + n);
}

template <int kDim>
typename StaticContact<kDim>::Trial StaticContact<kDim>::evaluate(const Eigen::VectorXd& q, const Origins& origin_m,
                                                                  const StaticState<kDim>* at) {
  Trial trial;
  const SoftPotential::Value v = body_.maps.potential.at(q);
  trial.state.energy_J = v.energy_J;
  trial.curvature = v.curvature;
  trial.state.q_m2 = q;
  trial.state.places = at != nullptr ? finder_.follow(q, origin_m, at->places)
                                     : finder_.find(q, origin_m, kReachOfExtent * body_.self.length_m);
  add_contacts(trial);
  return trial;
}

template <int kDim>
Eigen::VectorXd StaticContact<kDim>::slope(const StaticState<kDim>& at, const Origins& origin_m) {
  Eigen::VectorXd out(at.q_m2.size()), q = at.q_m2;
  for (Eigen::Index a = 0; a < q.size(); ++a) {
    q[a] = at.q_m2[a] + probe_m2_[a];
    const double ahead = evaluate(q, origin_m, &at).state.energy_J;
    q[a] = at.q_m2[a] - probe_m2_[a];
    out[a] = (ahead - evaluate(q, origin_m, &at).state.energy_J) / (2 * probe_m2_[a]);
    q[a] = at.q_m2[a];
  }
  return out;
}

template <int kDim>
fem::Point<kDim> StaticContact<kDim>::force_on(std::size_t tool, const StaticState<kDim>& at, Origins origin_m) {
  fem::Point<kDim> force{};
  const double probe = kProbeOfExtent * body_.self.length_m;
  for (std::size_t d = 0; d < static_cast<std::size_t>(kDim); ++d) {
    const double x = origin_m[tool][d];
    origin_m[tool][d] = x + probe;
    const double ahead = evaluate(at.q_m2, origin_m, &at).state.energy_J;
    origin_m[tool][d] = x - probe;
    force[d] = (evaluate(at.q_m2, origin_m, &at).state.energy_J - ahead) / (2 * probe);
    origin_m[tool][d] = x;
  }
  return force;
}

template <int kDim>
Eigen::VectorXd StaticContact<kDim>::step(const Eigen::MatrixXd& curvature, const Eigen::VectorXd& slope) const {
  double shift = 0;
  const Eigen::VectorXd& lambda = body_.maps.potential.lambda();
  for (int attempt = 0; attempt < 20; ++attempt) {
    Eigen::MatrixXd raised = curvature;
    raised.diagonal() += shift * lambda;
    const Eigen::LLT<Eigen::MatrixXd> factor(raised);
    if (factor.info() == Eigen::Success) return -factor.solve(slope);
    shift = shift > 0 ? 4 * shift : 1e-3;
  }
  return -slope.cwiseQuotient(lambda);
}

template <int kDim>
StaticState<kDim> StaticContact<kDim>::settle(const Origins& origin_m) {
  Trial now = evaluate(q_, origin_m);
  const Eigen::VectorXd inverse = body_.maps.potential.lambda().cwiseInverse();
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Eigen::VectorXd g = slope(now.state, origin_m);
    now.state.newton_steps = i;
    // The slope in the norm of the modes' energies, against the energy at hand.
    const double square = g.dot(inverse.cwiseProduct(g));
    now.state.residual = std::sqrt(square / std::max(now.state.energy_J, std::numeric_limits<double>::min()));
    if (!(square > kSlopeTolerance * kSlopeTolerance * now.state.energy_J)) {
      now.state.converged = true;
      break;
    }
    Eigen::VectorXd d = step(now.curvature, g);
    Trial next = evaluate(q_ + d, origin_m);
    for (int cut = 0; cut < kCuts && !(next.state.energy_J < now.state.energy_J); ++cut) {
      d *= 0.5;
      next = evaluate(q_ + d, origin_m);
    }
    if (!(next.state.energy_J < now.state.energy_J)) break;
    q_ += d;
    now = std::move(next);
  }
  return now.state;
}

template <int kDim>
void StaticContact<kDim>::place_tools(const Origins& origin_m) {
  origin_m_ = origin_m;
}

template <int kDim>
StaticState<kDim> StaticContact<kDim>::move_tools(const Origins& origin_m) {
  double travel = 0;
  for (std::size_t t = 0; t < origin_m.size(); ++t)
    for (std::size_t d = 0; d < static_cast<std::size_t>(kDim); ++d)
      travel = std::max(travel, std::abs(origin_m[t][d] - origin_m_[t][d]));
  const int steps = std::max(1, static_cast<int>(std::ceil(travel / (kStepOfExtent * body_.self.length_m))));
  const Origins start = origin_m_;
  StaticState<kDim> state;
  for (int i = 1; i <= steps; ++i) {
    for (std::size_t t = 0; t < origin_m.size(); ++t)
      for (std::size_t d = 0; d < static_cast<std::size_t>(kDim); ++d)
        origin_m_[t][d] = start[t][d] + (origin_m[t][d] - start[t][d]) * i / steps;
    state = settle(origin_m_);
  }
  for (std::size_t t = 0; t < origin_m.size(); ++t) state.force_on_tool_N.push_back(force_on(t, state, origin_m_));
  return state;
}

template class StaticContact<2>;
template class StaticContact<3>;

}  // namespace palpate::elastic
