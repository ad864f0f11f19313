#include "rt_core/nodal/pivoting.h"

#include "rt_core/vec.h"

namespace palpate {

namespace {

// M over the active contacts, as the lower triangle of the factor. Rows past the last are zero.
void gather_active(NormalProblem& p) PALPATE_RT {
  ContactFactor& factor = p.factor;
  const std::int32_t rows = whole_lanes(factor.n, 4);
  for (std::int32_t j = 0; j < factor.n; ++j) {  // bound: kMaxContacts^2 / 2
    const double* from = p.compliance[p.active[j]];
    double* to = factor.column[j];
    for (std::int32_t i = j / 4 * 4; i < j; ++i) to[i] = 0;
    for (std::int32_t i = j; i < factor.n; ++i) to[i] = from[p.active[i]];
    for (std::int32_t i = factor.n; i < rows; ++i) to[i] = 0;
  }
}

// Pushes that close exactly the active contacts; false when M is not positive definite over them.
bool close_active(NormalProblem& p) PALPATE_RT {
  gather_active(p);
  p.pivots += 1;
  p.factored = factorise(p.factor) ? 1 : 0;
  if (p.factored == 0) return false;
  alignas(32) double x[kContactStride];
  const std::int32_t rows = whole_lanes(p.factor.n, 4);
  for (std::int32_t k = 0; k < rows; ++k) x[k] = k < p.factor.n ? -p.free_gap_m[p.active[k]] : 0.0;
  solve_lower(p.factor, x);
  solve_upper(p.factor, x);
  for (std::int32_t i = 0; i < p.n; ++i) p.push_N[i] = 0;  // bound: kMaxContacts
  for (std::int32_t k = 0; k < p.factor.n; ++k) p.push_N[p.active[k]] = x[k];
  return true;
}

void add_gaps(NormalProblem& p) PALPATE_RT {
  const std::int32_t rows = whole_lanes(p.n, 4);
  for (std::int32_t i = 0; i < rows; i += 4) store(p.gap_m + i, load4(p.free_gap_m + i));
  for (std::int32_t j = 0; j < p.n; ++j) {  // bound: kMaxContacts^2 / 4
    if (p.push_N[j] == 0) continue;
    const Double4 s = splat4(p.push_N[j]);
    for (std::int32_t i = 0; i < rows; i += 4) store(p.gap_m + i, load4(p.gap_m + i) + load4(p.compliance[j] + i) * s);
  }
}

struct Exchange {
  bool wrong[kMaxContacts];
  std::int32_t count = 0, last = -1;
};

// Contacts on the wrong side: active ones that pull, open ones that penetrate.
Exchange find_wrong(const NormalProblem& p, const bool (&is_active)[kMaxContacts], double tolerance_m) PALPATE_RT {
  Exchange exchange;
  for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMaxContacts
    exchange.wrong[i] = is_active[i] ? p.push_N[i] * p.compliance[i][i] < -tolerance_m : p.gap_m[i] < -tolerance_m;
    if (!exchange.wrong[i]) continue;
    exchange.count += 1;
    exchange.last = i;
  }
  return exchange;
}

void list_active(NormalProblem& p, const bool (&is_active)[kMaxContacts]) PALPATE_RT {
  p.factor.n = 0;
  for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMaxContacts
    if (is_active[i]) p.active[p.factor.n++] = i;
  }
}

// The whole vector lanes past n hold zeros, so that they take part in sums harmlessly.
void pad(NormalProblem& p) PALPATE_RT {
  for (std::int32_t i = p.n; i < whole_lanes(p.n, 4); ++i) {  // bound: 3
    p.free_gap_m[i] = p.push_N[i] = p.gap_m[i] = 0;
    for (std::int32_t j = 0; j < p.n; ++j) p.compliance[j][i] = 0;  // bound: kMaxContacts
  }
}

}  // namespace

void measure_gaps(NormalProblem& p) PALPATE_RT {
  pad(p);
  add_gaps(p);
  p.residual_m = 0;
  for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMaxContacts
    const double push_m = p.push_N[i] * p.compliance[i][i];
    const double wrong = abs_of(push_m < p.gap_m[i] ? push_m : p.gap_m[i]);
    if (!(wrong <= p.residual_m)) p.residual_m = wrong;
  }
}

void solve_sweeping(NormalProblem& p, std::int32_t sweeps) PALPATE_RT {
  p.factored = 0;
  for (std::int32_t i = 0; i < p.n; ++i) p.push_N[i] = max_of(p.push_N[i], 0.0);  // NaN becomes 0
  pad(p);
  add_gaps(p);
  const std::int32_t rows = whole_lanes(p.n, 4);
  for (std::int32_t sweep = 0; sweep < sweeps; ++sweep) {  // bound: 100, from the image
    for (std::int32_t j = 0; j < p.n; ++j) {               // bound: kMaxContacts
      const double next = max_of(p.push_N[j] - p.gap_m[j] / p.compliance[j][j], 0.0);
      const double step = next - p.push_N[j];
      if (step == 0) continue;
      p.push_N[j] = next;
      const Double4 s = splat4(step);
      for (std::int32_t i = 0; i < rows; i += 4)
        store(p.gap_m + i, load4(p.gap_m + i) + load4(p.compliance[j] + i) * s);
    }
  }
  measure_gaps(p);
}

void solve_pivoting(NormalProblem& p) PALPATE_RT {
  pad(p);
  bool is_active[kMaxContacts];
  double largest_m = 0;
  for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMaxContacts
    is_active[i] = p.push_N[i] > 0;
    largest_m = max_of(largest_m, abs_of(p.free_gap_m[i]));
  }
  const double tolerance_m = 1e-10 * largest_m;
  std::int32_t best = p.n + 1, patience = 3;
  p.pivots = 0;
  for (std::int32_t pivot = 0; pivot < kMaxPivots; ++pivot) {  // bound: kMaxPivots
    list_active(p, is_active);
    if (!close_active(p)) break;
    add_gaps(p);
    const Exchange exchange = find_wrong(p, is_active, tolerance_m);
    if (exchange.count == 0) {
      for (std::int32_t i = 0; i < p.n; ++i) p.push_N[i] = max_of(p.push_N[i], 0.0);
      return measure_gaps(p);
    }
    // All at once while that makes progress; otherwise the last one only, which always ends (Murty 1974).
    if (exchange.count < best) {
      best = exchange.count;
      patience = 3;
    } else {
      patience -= 1;
    }
    for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMaxContacts
      if (exchange.wrong[i] && (patience >= 0 || i == exchange.last)) is_active[i] = !is_active[i];
    }
  }
  solve_sweeping(p, kFallbackSweeps);
}

}  // namespace palpate
