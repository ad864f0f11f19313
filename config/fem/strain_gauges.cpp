#include "config/fem/strain_gauges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "config/fem/tet_element.h"
#include "config/index.h"

namespace palpate {

namespace {

// Components xx yy zz xy yz zx as pairs of axes.
constexpr std::size_t kPair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};

// Gauge candidates are the four integration points of every element: bending strain is better there than at nodes
// (Barlow 1976), and they lie near the surface.
struct Candidate {
  std::size_t tet;
  Vec3 position_m;
  std::array<std::int32_t, 10> node;
  std::array<Vec3, 10> gradient_1pm;
};

std::vector<Candidate> candidates_of(const TetMesh& mesh) {
  std::vector<Candidate> out;
  for (std::size_t t = 0; t < mesh.tet.size(); ++t)
    for (const TetPoint& p : tet_rule_4()) {
      const Tet& tet = mesh.tet[t];
      Candidate c{t, {}, tet.node, {}};
      const TetMapping mapping = map_tet(mesh, tet, p.lambda);
      const TetValues shape = tet_shape(tet, p.lambda);
      for (std::size_t k = 0; k < 10; ++k) {
        if (tet.node[k] < 0) continue;
        const auto row = static_cast<Eigen::Index>(k);
        c.position_m += shape(row) * mesh.node_m[at(tet.node[k])];
        c.gradient_1pm[k] = {mapping.gradient_1pm(row, 0), mapping.gradient_1pm(row, 1), mapping.gradient_1pm(row, 2)};
      }
      out.push_back(c);
    }
  return out;
}

std::array<double, 3> axes(Vec3 v) { return {v.x, v.y, v.z}; }

std::array<double, 6> strain_at(const Candidate& c, const std::vector<Vec3>& u) {
  std::array<double, 6> strain{};
  for (std::size_t k = 0; k < 10; ++k) {
    if (c.node[k] < 0) continue;
    const auto g = axes(c.gradient_1pm[k]), d = axes(u[at(c.node[k])]);
    for (std::size_t p = 0; p < 6; ++p) {
      const auto [a, b] = std::pair(kPair[p][0], kPair[p][1]);
      strain[p] += 0.5 * (g[b] * d[a] + g[a] * d[b]);
    }
  }
  return strain;
}

struct Press {
  Vec3 centre_m;
  double reach_m;  // strain within it is the press's own
  std::vector<Vec3> force_N;
};

// Unit pushes along the inward normals, each shared by a vertex and its neighbours.
std::vector<Press> presses_on(const TetMesh& mesh, const CondensedBody& body) {
  std::vector<std::vector<std::size_t>> ring(body.node.size());
  for (const Corners& c : body.surface.triangle)
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) ring[at(c[k])].push_back(at(c[other]));
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < body.held.size(); ++i)
    if (body.held[i] == 0) free.push_back(i);
  std::vector<Press> out;
  const std::size_t count = std::min(kGaugePresses, free.size());
  for (std::size_t s = 0; s < count; ++s) {
    const std::size_t i = free[s * free.size() / count];
    Press press{body.surface.vertex_m[i], 0, std::vector<Vec3>(mesh.node_m.size())};
    std::vector<std::size_t> pushed = ring[i];
    pushed.push_back(i);
    for (const std::size_t j : pushed) {
      press.reach_m = std::max(press.reach_m, 2.0 * norm(body.surface.vertex_m[j] - press.centre_m));
      press.force_N[at(body.node[j])] += (-1.0 / static_cast<double>(pushed.size())) * body.normal[i];
    }
    out.push_back(std::move(press));
  }
  return out;
}

// Share of each press's largest strain that each candidate sees; candidates that are nobody's largest are left out.
struct Shares {
  std::vector<std::size_t> candidate;
  std::vector<std::vector<double>> of_press;  // [press][candidate]
};

Shares shares_of(const std::vector<Candidate>& candidates, const std::vector<Press>& presses,
                 const std::vector<std::vector<Vec3>>& displacement_m) {
  std::vector<std::vector<double>> size(presses.size(), std::vector<double>(candidates.size(), 0.0));
  Shares shares;
  for (std::size_t s = 0; s < presses.size(); ++s) {
    for (std::size_t c = 0; c < candidates.size(); ++c)
      if (norm(candidates[c].position_m - presses[s].centre_m) > presses[s].reach_m)
        size[s][c] = strain_size(strain_at(candidates[c], displacement_m[s]).data());
    shares.candidate.push_back(
        static_cast<std::size_t>(std::max_element(size[s].begin(), size[s].end()) - size[s].begin()));
  }
  std::sort(shares.candidate.begin(), shares.candidate.end());
  shares.candidate.erase(std::unique(shares.candidate.begin(), shares.candidate.end()), shares.candidate.end());
  for (std::size_t s = 0; s < presses.size(); ++s) {
    const double largest = *std::max_element(size[s].begin(), size[s].end());
    shares.of_press.emplace_back();
    for (const std::size_t c : shares.candidate) shares.of_press[s].push_back(largest > 0 ? size[s][c] / largest : 1.0);
  }
  return shares;
}

// Greedy cover: each round takes the candidate that adds most to the sum over presses of the share seen.
std::vector<std::size_t> cover(const Shares& shares, std::size_t count, std::vector<double>& seen) {
  std::vector<std::size_t> chosen;
  seen.assign(shares.of_press.size(), 0.0);
  while (chosen.size() < std::min(count, shares.candidate.size())) {
    double best_gain = 0;
    std::size_t best = 0;
    for (std::size_t c = 0; c < shares.candidate.size(); ++c) {
      double gain = 0;
      for (std::size_t s = 0; s < seen.size(); ++s) gain += std::max(0.0, shares.of_press[s][c] - seen[s]);
      if (gain > best_gain) best_gain = gain, best = c;
    }
    if (!(best_gain > 1e-3)) break;  // nothing left to see
    chosen.push_back(shares.candidate[best]);
    for (std::size_t s = 0; s < seen.size(); ++s) seen[s] = std::max(seen[s], shares.of_press[s][best]);
  }
  return chosen;
}

// Strain component p as a force vector b, so that the component is b . u; by reciprocity K^-1 b holds its response to
// a unit force anywhere.
std::vector<Vec3> strain_load(const Candidate& c, std::size_t p, std::size_t nodes) {
  std::vector<Vec3> load(nodes);
  for (std::size_t k = 0; k < 10; ++k) {
    if (c.node[k] < 0) continue;
    const auto g = axes(c.gradient_1pm[k]);
    std::array<double, 3> b{};
    b[kPair[p][0]] += 0.5 * g[kPair[p][1]];
    b[kPair[p][1]] += 0.5 * g[kPair[p][0]];
    load[at(c.node[k])] += Vec3{b[0], b[1], b[2]};
  }
  return load;
}

}  // namespace

double strain_size(const double* e) {
  return std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + 2.0 * (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]));
}

StrainGauges place_strain_gauges(const LinearBody& solver, const TetMesh& mesh, const CondensedBody& body,
                                 std::size_t count, const Progress& progress) {
  if (progress) progress("strain gauges", 0);
  const std::vector<Candidate> candidates = candidates_of(mesh);
  const std::vector<Press> presses = presses_on(mesh, body);
  std::vector<std::vector<Vec3>> load;
  for (const Press& press : presses) load.push_back(press.force_N);
  std::vector<double> seen;
  const std::vector<std::size_t> chosen = cover(shares_of(candidates, presses, solver.solve_all_m(load)), count, seen);
  if (progress) progress("strain gauges", 0.5);
  StrainGauges gauges;
  load.clear();
  for (const std::size_t c : chosen) {
    gauges.tet.push_back(static_cast<std::int32_t>(candidates[c].tet));
    gauges.position_m.push_back(candidates[c].position_m);
    for (std::size_t p = 0; p < 6; ++p) load.push_back(strain_load(candidates[c], p, mesh.node_m.size()));
  }
  const std::vector<std::vector<Vec3>> response = solver.solve_all_m(load);
  for (const std::int32_t node : body.node)
    for (std::size_t a = 0; a < 3; ++a)
      for (const std::vector<Vec3>& u : response) gauges.strain_1pN.push_back(axes(u[at(node)])[a]);
  gauges.worst_share = seen.empty() ? 0.0 : *std::min_element(seen.begin(), seen.end());
  for (const double s : seen) gauges.mean_share += s / static_cast<double>(seen.size());
  if (progress) progress("strain gauges", 1);
  return gauges;
}

}  // namespace palpate
