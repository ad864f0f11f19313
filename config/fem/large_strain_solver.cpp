#include "config/fem/large_strain_solver.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "config/fem/contact_points.h"
#include "config/fem/large_strain_assembly.h"
#include "config/fem/supernodal_factor.h"
#include "config/scene/config_error.h"

namespace palpate::fem {

namespace {

// Contact springs per stiffness of their nodes. Hard enough that two or three augmentations close the gap; springs of
// 100 need three times the Newton steps, because points then cannot slide along a curved tool (measured 2026-11-21).
constexpr double kPenaltyShare = 10;

// Of the shortest facet: the step off a saddle.
constexpr double kSaddleStep = 0.1;

void check_body(const StrainBody& body, int dim) {
  if (!(body.youngs_modulus_Pa > 0))
    throw ConfigError("large-strain solver: Young's modulus must be above 0 Pa, got " +
                      std::to_string(body.youngs_modulus_Pa));
  if (!(body.poisson_ratio > -1 && body.poisson_ratio <= 0.4999))
    throw ConfigError("large-strain solver: Poisson's ratio must lie in (-1, 0.4999], got " +
                      std::to_string(body.poisson_ratio) + "; write 0.4999 for an incompressible material");
  for (const ElementMaterial& m : body.element)
    if (!(m.youngs_modulus_Pa > 0) || !(m.poisson_ratio > -1 && m.poisson_ratio <= 0.4999))
      throw ConfigError(
          "large-strain solver: an element's Young's modulus must be above 0 Pa and Poisson's ratio in "
          "(-1, 0.4999]");
  if ((dim == 3) != (body.kinematics == Kinematics::kSolid))
    throw ConfigError("large-strain solver: kinematics and dimension of the mesh differ");
}

}  // namespace

template <int kDim>
struct LargeStrainSolver<kDim>::Impl {
  using Vector = Eigen::Matrix<double, kDim, 1>;
  using Square = Eigen::Matrix<double, kDim, kDim>;
  struct Situation {  // what move_tools and load change
    std::vector<Point<kDim>> origin_m;
    Eigen::VectorXd load_N, fixed_u_m;
  };

  Impl(const StrainMesh<kDim>& mesh_in, const StrainBody& body_in, const std::vector<bool>& fixed_in,
       std::vector<int> nodes, std::vector<RigidTool> tools_in, const StrainOptions& options_in)
      : mesh(mesh_in),
        body(body_in),
        options(options_in),
        contacts(contact_points(mesh_in, nodes)),
        tools(std::move(tools_in)),
        assembly(mesh_in, body_in, number_equations(fixed_in)),
        tangent(assembly.pattern()) {
    const Eigen::Index dofs = static_cast<Eigen::Index>(mesh.node_count()) * kDim;
    u = Eigen::VectorXd::Zero(dofs);
    now = {std::vector<Point<kDim>>(tools.size(), Point<kDim>{}), Eigen::VectorXd::Zero(dofs),
           Eigen::VectorXd::Zero(dofs)};
    multiplier.assign(contacts.size() * tools.size(), 0.0);
    factor.analyse(tangent);
    find_penalties();
  }

  static std::vector<int> number_equations(const std::vector<bool>& fixed) {
    std::vector<int> equation;
    int next = 0;
    for (const bool f : fixed) equation.push_back(f ? -1 : next++);
    return equation;
  }

  void find_penalties() {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(u.size());
    assembly.evaluate(u, &force, &tangent);
    rest_tangent = tangent;
    if (body.law == StrainLaw::kLinear) {
      const LargeStrainAssembly<kDim> whole(mesh, body,
                                            number_equations(std::vector<bool>(static_cast<std::size_t>(u.size()))));
      linear_stiffness = whole.pattern();
      whole.evaluate(u, nullptr, &linear_stiffness);
    }
    for (const ContactPoint& point : contacts) {
      const Point<kDim>& a = mesh.nodes_m[static_cast<std::size_t>(point.nodes[0])];
      const Point<kDim>& b = mesh.nodes_m[static_cast<std::size_t>(point.nodes[2])];
      double square = 0;
      for (std::size_t i = 0; i < a.size(); ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
      shortest_facet_m = std::min(shortest_facet_m, std::sqrt(square));
      double largest = 0;
      for (const int node : point.nodes)
        for (int i = 0; i < kDim; ++i)
          if (const int q = assembly.equation(node * kDim + i); q >= 0)
            largest = std::max(largest, tangent.coeff(q, q));
      penalty.push_back(kPenaltyShare * point.share * largest);
    }
  }

  // A contact point at rest, or displaced.
  Point<kDim> place(std::size_t contact, const Eigen::VectorXd* at) const {
    const ContactPoint& point = contacts[contact];
    Point<kDim> p{};
    for (std::size_t a = 0; a < point.nodes.size(); ++a)
      for (int i = 0; i < kDim; ++i) {
        const std::size_t si = static_cast<std::size_t>(i);
        p[si] += point.shape[a] * (mesh.nodes_m[static_cast<std::size_t>(point.nodes[a])][si] +
                                   (at == nullptr ? 0.0 : (*at)[point.nodes[a] * kDim + i]));
      }
    return p;
  }

  Gap<kDim> gap(std::size_t contact, std::size_t tool, const Situation& s, const Eigen::VectorXd& at) const {
    const bool linear = body.law == StrainLaw::kLinear;
    Point<kDim> p = place(contact, linear ? nullptr : &at);
    for (std::size_t i = 0; i < p.size(); ++i) p[i] -= s.origin_m[tool][i];
    if (!linear) return gap_of<kDim>(tools[tool], p);
    Gap<kDim> g = gap_along_press<kDim>(tools[tool], p);
    const Point<kDim> rest = place(contact, nullptr), moved = place(contact, &at);
    for (std::size_t i = 0; i < p.size(); ++i) g.value_m += g.normal[i] * (moved[i] - rest[i]);
    return g;
  }

  double elastic(const Eigen::VectorXd& at, Eigen::VectorXd* force, Eigen::SparseMatrix<double>* stiffness) const {
    if (body.law == StrainLaw::kNeoHookean) return assembly.evaluate(at, force, stiffness);
    const Eigen::VectorXd product = linear_stiffness.template selfadjointView<Eigen::Lower>() * at;
    if (force != nullptr) *force += product;
    if (stiffness != nullptr) *stiffness += rest_tangent;
    return 0.5 * at.dot(product);
  }

  Eigen::VectorXd gather(const Eigen::VectorXd& full) const {
    Eigen::VectorXd reduced(assembly.free_count());
    for (int dof = 0; dof < full.size(); ++dof)
      if (const int q = assembly.equation(dof); q >= 0) reduced[q] = full[dof];
    return reduced;
  }

  // The augmented potential: elastic energy, dead loads, and per contact (max(0, l - e g)^2 - l^2) / 2e.
  double potential(const Situation& s, const Eigen::VectorXd& at, Eigen::VectorXd* residual, bool with_tangent) {
    if (with_tangent) std::fill(tangent.valuePtr(), tangent.valuePtr() + tangent.nonZeros(), 0.0);
    if (residual != nullptr) *residual = -s.load_N;
    double sum = elastic(at, residual, with_tangent ? &tangent : nullptr) - s.load_N.dot(at);
    if (residual != nullptr) internal_scale = residual->cwiseAbs().maxCoeff();
    for (std::size_t c = 0; c < contacts.size(); ++c)
      for (std::size_t t = 0; t < tools.size(); ++t) {
        const double l = multiplier[c * tools.size() + t], e = penalty[c];
        const Gap<kDim> g = gap(c, t, s, at);
        const double p = std::max(0.0, l - e * g.value_m);
        sum += (p * p - l * l) / (2 * e);
        if (!(p > 0) || residual == nullptr) continue;
        // A ball that a step has carried deep into the body as it was presses with far too much: with its curvature the
        // tangent would be indefinite, and Newton's steps short (a dome's press: 100 factors instead of 33).
        const double bend = options.stable ? std::min(p, l) : p;
        Square block;
        for (int i = 0; i < kDim; ++i) {
          const std::size_t si = static_cast<std::size_t>(i);
          for (std::size_t a = 0; a < contacts[c].nodes.size(); ++a)
            (*residual)[contacts[c].nodes[a] * kDim + i] -= contacts[c].shape[a] * p * g.normal[si];
          for (int j = 0; j < kDim; ++j)
            block(i, j) = e * g.normal[si] * g.normal[static_cast<std::size_t>(j)] -
                          bend * g.curvature_per_m[si][static_cast<std::size_t>(j)];
        }
        if (with_tangent) assembly.add_nodes_block(contacts[c].nodes, contacts[c].shape, block, tangent);
      }
    return sum;
  }

  // Newton direction; where the tangent is not a descent (past a limit point the load path handles it, but a poor guess
  // may end there too) the diagonal is raised until it is.
  bool direction(const Eigen::VectorXd& reduced, Eigen::VectorXd& step) {
    const double least = 1e-4 * tangent.diagonal().cwiseAbs().mean();
    // A tenth of what was needed last: in a row of indefinite tangents two factors instead of five each time.
    double shift = last_shift > least ? 0.1 * last_shift : 0;
    for (int attempt = 0; attempt < 8; ++attempt) {
      if (factor.factorise(tangent, shift) && !(options.stable && factor.negative_pivots() > 0)) {
        step = -factor.solve(reduced);
        last_shift = shift;
        if (step.allFinite() && step.dot(reduced) < 0) return true;
      }
      shift = shift > 0 ? 10 * shift : least;
    }
    return false;
  }

  // Where the tangent at an equilibrium has a negative eigenvalue, a step along its vector, found by inverse iteration.
  bool leave_saddle(const Situation& s, Eigen::VectorXd& at) {
    Eigen::VectorXd residual;
    potential(s, at, &residual, true);
    if (!factor.factorise(tangent, 0) || factor.negative_pivots() == 0) return false;
    Eigen::VectorXd v(assembly.free_count());
    for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = 1 + 0.1 * static_cast<double>(i % 7);
    for (int i = 0; i < 8; ++i) v = factor.solve(v.normalized());
    v *= kSaddleStep * shortest_facet_m / v.cwiseAbs().maxCoeff();
    for (int dof = 0; dof < at.size(); ++dof)
      if (const int q = assembly.equation(dof); q >= 0) at[dof] += v[q];
    return true;
  }

  bool minimise(const Situation& s, Eigen::VectorXd& at, double tolerance) {
    Eigen::VectorXd residual, step, trial;
    for (int iteration = 0; iteration < options.max_newton; ++iteration) {
      const double value = potential(s, at, &residual, true);
      if (!std::isfinite(value)) return false;
      const Eigen::VectorXd reduced = gather(residual);
      if (!(reduced.cwiseAbs().maxCoeff() > tolerance * internal_scale + force_floor())) return true;
      ++newton_steps;
      if (!direction(reduced, step)) return false;
      const double slope = step.dot(reduced);
      double length = 1;
      for (int cut = 0;; ++cut) {
        trial = at;
        for (int dof = 0; dof < at.size(); ++dof)
          if (const int q = assembly.equation(dof); q >= 0) trial[dof] += length * step[q];
        const bool folded = body.law == StrainLaw::kNeoHookean && !assembly.unfolded(trial);
        const double next = folded ? std::numeric_limits<double>::infinity() : potential(s, trial, nullptr, false);
        // Close to the minimum the decrease drowns in rounding of the energy: then the step is taken as it is.
        if (next <= value + 1e-4 * length * slope + 1e-11 * std::abs(value)) break;
        if (cut == 12) return false;
        length *= 0.5;
      }
      at = trial;
    }
    return false;
  }

  // Below this a nodal force is rounding: E times the square of the smallest length the mesh can tell from zero.
  double force_floor() const { return 1e-13 * penalty_mean() * options.gap_tolerance; }
  double penalty_mean() const {
    double sum = 0;
    for (const double p : penalty) sum += p;
    return penalty.empty() ? rest_tangent.diagonal().mean() * 1e-3 : sum / static_cast<double>(penalty.size());
  }

  // Minimise, move the multipliers to the contact forces found, repeat until no contact is deeper than the tolerance.
  bool equilibrium(const Situation& s, double extrapolate) {
    Eigen::VectorXd at = u;
    const std::vector<double> multiplier_before = multiplier;
    if (extrapolate > 0) {
      at += extrapolate * last_u;
      for (std::size_t i = 0; i < multiplier.size(); ++i)
        multiplier[i] = std::max(0.0, multiplier[i] + extrapolate * last_multiplier[i]);
    }
    for (int dof = 0; dof < at.size(); ++dof)
      if (assembly.equation(dof) < 0) at[dof] = s.fixed_u_m[dof];
    for (int k = 0; k < options.max_augmentations; ++k) {
      if (!minimise(s, at, options.residual_tolerance)) break;
      double worst = 0;
      for (std::size_t c = 0; c < contacts.size(); ++c)
        for (std::size_t t = 0; t < tools.size(); ++t) {
          double& l = multiplier[c * tools.size() + t];
          const double p = std::max(0.0, l - penalty[c] * gap(c, t, s, at).value_m);
          worst = std::max(worst, std::abs(p - l) / penalty[c]);
          l = p;
        }
      if (worst <= options.gap_tolerance * shortest_facet_m || tools.empty()) {
        if (options.stable && leave_saddle(s, at)) continue;
        u = at;
        penetration_m = worst;
        return true;
      }
    }
    multiplier = multiplier_before;
    return false;
  }

  // A point that one step carries past a rounded edge, or surface elements that it crushes before the rest follows, end
  // in another equilibrium than the one a slow press reaches (seen 2026-11-21: 10 to 16 % of a punch's force).
  double longest_step() const {
    double step = std::numeric_limits<double>::infinity();
    for (const RigidTool& tool : tools)
      if (tool.shape == RigidShape::kPunch) step = std::min(step, 0.5 * tool.fillet_m);
    return body.law == StrainLaw::kLinear ? step : std::min(step, options.step_facets * shortest_facet_m);
  }

  // One step, first from the last one continued: a guess without the dents that a tool jumping into the rest makes.
  bool step_to(const Situation& s) {
    Eigen::VectorXd motion(static_cast<Eigen::Index>(tools.size()) * kDim);
    for (std::size_t t = 0; t < tools.size(); ++t)
      for (std::size_t i = 0; i < static_cast<std::size_t>(kDim); ++i)
        motion[static_cast<Eigen::Index>(t * kDim + i)] = s.origin_m[t][i] - now.origin_m[t][i];
    double ratio = 0;
    if (last_motion.size() == motion.size() && last_motion.squaredNorm() > 0) {
      ratio = motion.dot(last_motion) / last_motion.squaredNorm();
      const bool ahead = motion.dot(last_motion) > 0.99 * motion.norm() * last_motion.norm() && ratio < 3;
      if (!ahead || (body.law == StrainLaw::kNeoHookean && !assembly.unfolded(u + ratio * last_u))) ratio = 0;
    }
    const Eigen::VectorXd u_before = u;
    const std::vector<double> multiplier_before = multiplier;
    if (!(ratio > 0 && equilibrium(s, ratio)) && !equilibrium(s, 0)) return false;
    last_motion = motion;
    last_u = u - u_before;
    last_multiplier = multiplier;
    for (std::size_t i = 0; i < multiplier.size(); ++i) last_multiplier[i] -= multiplier_before[i];
    now = s;
    return true;
  }

  PressState<kDim> go(const Situation& target) {
    const Situation start = now;
    const Eigen::VectorXd u_before = u;
    const std::vector<double> multiplier_before = multiplier;
    newton_steps = 0;
    double travel = 0;
    for (std::size_t t = 0; t < tools.size(); ++t)
      for (std::size_t i = 0; i < static_cast<std::size_t>(kDim); ++i)
        travel = std::max(travel, std::abs(target.origin_m[t][i] - start.origin_m[t][i]));
    if (!(travel > 0)) travel = 1e-12;  // loads alone: one step
    double done = 0, length = std::min(1.0, longest_step() / travel);
    const double shortest = std::ldexp(length, -options.max_cuts);
    while (done < 1) {
      const double share = std::min(1.0, done + length);
      Situation s = target;
      for (std::size_t t = 0; t < tools.size(); ++t)
        for (std::size_t i = 0; i < static_cast<std::size_t>(kDim); ++i)
          s.origin_m[t][i] = start.origin_m[t][i] + share * (target.origin_m[t][i] - start.origin_m[t][i]);
      s.load_N = start.load_N + share * (target.load_N - start.load_N);
      s.fixed_u_m = start.fixed_u_m + share * (target.fixed_u_m - start.fixed_u_m);
      if (step_to(s)) {
        done = share;
      } else if ((length *= 0.5) < shortest) {
        now = start;
        u = u_before;
        multiplier = multiplier_before;
        return result(false);
      }
    }
    return result(true);
  }

  PressState<kDim> result(bool converged) {
    PressState<kDim> state;
    state.converged = converged;
    Eigen::VectorXd internal = Eigen::VectorXd::Zero(u.size());
    state.energy_J = elastic(u, &internal, nullptr);
    state.u_m.assign(u.data(), u.data() + u.size());
    state.newton_steps = newton_steps;
    state.penetration_m = penetration_m;
    for (int dof = 0; dof < u.size(); ++dof)
      if (assembly.equation(dof) < 0) state.support_reaction_N[static_cast<std::size_t>(dof % kDim)] += internal[dof];
    const Eigen::VectorXd bed = assembly.spring_force(u);
    for (int dof = 0; dof < u.size(); ++dof) state.support_reaction_N[static_cast<std::size_t>(dof % kDim)] -= bed[dof];
    state.force_on_tool_N.assign(tools.size(), Point<kDim>{});
    for (std::size_t c = 0; c < contacts.size(); ++c)
      for (std::size_t t = 0; t < tools.size(); ++t) {
        const double l = multiplier[c * tools.size() + t];
        if (!(l > 0)) continue;
        const Gap<kDim> g = gap(c, t, now, u);
        ++state.active_contacts;
        state.contact_radius_m = std::max(state.contact_radius_m, std::abs(place(c, &u)[0]));
        for (std::size_t i = 0; i < static_cast<std::size_t>(kDim); ++i) state.force_on_tool_N[t][i] -= l * g.normal[i];
      }
    return state;
  }

  StrainMesh<kDim> mesh;
  StrainBody body;
  StrainOptions options;
  std::vector<ContactPoint> contacts;
  std::vector<RigidTool> tools;
  LargeStrainAssembly<kDim> assembly;
  Eigen::SparseMatrix<double> tangent, rest_tangent, linear_stiffness;  // the last: fixed nodes too, linear law only
  SupernodalFactor factor;
  double last_shift = 0;                   // of direction()
  Eigen::VectorXd u, last_u, last_motion;  // the last step's change of u and of the tools
  Situation now;
  std::vector<double> multiplier, last_multiplier, penalty;
  double shortest_facet_m = std::numeric_limits<double>::infinity();
  double internal_scale = 0, penetration_m = 0;
  int newton_steps = 0;
};

template <int kDim>
LargeStrainSolver<kDim>::LargeStrainSolver(const StrainMesh<kDim>& mesh, const StrainBody& body,
                                           const std::vector<bool>& fixed, std::vector<int> contact_nodes,
                                           std::vector<RigidTool> tools, const StrainOptions& options) {
  check_body(body, kDim);
  impl_ = std::make_unique<Impl>(mesh, body, fixed, std::move(contact_nodes), std::move(tools), options);
}
template <int kDim>
LargeStrainSolver<kDim>::~LargeStrainSolver() = default;
template <int kDim>
LargeStrainSolver<kDim>::LargeStrainSolver(LargeStrainSolver&&) noexcept = default;

template <int kDim>
void LargeStrainSolver<kDim>::place_tools(const std::vector<Point<kDim>>& origin_m) {
  impl_->now.origin_m = origin_m;
}

template <int kDim>
PressState<kDim> LargeStrainSolver<kDim>::move_tools(const std::vector<Point<kDim>>& origin_m) {
  typename Impl::Situation target = impl_->now;
  target.origin_m = origin_m;
  return impl_->go(target);
}

template <int kDim>
PressState<kDim> LargeStrainSolver<kDim>::load(const std::vector<double>& force_N,
                                               const std::vector<double>& displacement_m) {
  typename Impl::Situation target = impl_->now;
  const auto copy = [](const std::vector<double>& from, Eigen::VectorXd& to) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(to.size()); ++i)
      to[static_cast<Eigen::Index>(i)] = from.empty() ? 0.0 : from[i];
  };
  copy(force_N, target.load_N);
  copy(displacement_m, target.fixed_u_m);
  return impl_->go(target);
}

template class LargeStrainSolver<2>;
template class LargeStrainSolver<3>;

}  // namespace palpate::fem
