#include "rt_core/contact/nodes/pivoting.h"

#include "rt_core/vec.h"

namespace palpate {

namespace {

// M over the active contacts, as the lower triangle of the factor. Rows past the last are zero. Where four of the
// contacts follow one another they are copied as one.
void gather_active(NormalProblem& p) PALPATE_RT {
  ContactFactor& factor = p.factor;
  const std::int32_t n = factor.n, rows = whole_lanes(n, 4);
  p.vectors += n * rows / 4;
  bool joined[kMaxContacts / 4];
  for (std::int32_t i = 0; i < rows; i += 4) joined[i / 4] = i + 4 <= n && p.active[i + 3] == p.active[i] + 3;
  for (std::int32_t j = 0; j < n; ++j) {  // bound: kMaxContacts^2 / 8 vectors
    const double* from = p.compliance[p.active[j]];
    double* to = factor.column[j];
    for (std::int32_t i = j / 4 * 4; i < rows; i += 4) {
      if (joined[i / 4]) {
        store(to + i, load4(from + p.active[i]));
        continue;
      }
      for (std::int32_t k = i; k < i + 4; ++k) to[k] = k < n ? from[p.active[k]] : 0;  // bound: 4
    }
  }
}

// Pushes that close exactly the contacts of the factor.
void close_active(NormalProblem& p) PALPATE_RT {
  const ContactFactor& factor = p.factor;
  alignas(32) double x[kContactStride];
  for (std::int32_t k = 0; k < whole_lanes(factor.n, 4); ++k) {  // bound: kMaxContacts
    x[k] = k < factor.n && p.active[k] >= 0 ? -p.free_gap_m[p.active[k]] : 0.0;
  }
  p.vectors += factor.n * (factor.n + 8) / 4;
  solve_lower(factor, x);
  solve_upper(factor, x);
  for (std::int32_t i = 0; i < p.n; ++i) p.push_N[i] = 0;  // bound: kMaxContacts
  for (std::int32_t k = 0; k < factor.n; ++k) {            // bound: kMaxContacts
    if (p.active[k] >= 0) p.push_N[p.active[k]] = x[k];
  }
}

void add_gaps(NormalProblem& p) PALPATE_RT {
  const std::int32_t rows = whole_lanes(p.n, 4);
  std::int32_t pushing[kMaxContacts], count = 0;
  for (std::int32_t j = 0; j < p.n; ++j) {  // bound: kMaxContacts
    if (p.push_N[j] != 0) pushing[count++] = j;
  }
  p.vectors += (count + 8) * rows / 4;
  for (std::int32_t i = 0; i < rows; i += 16) {  // bound: kMaxContacts / 16; the stride is whole sixteens
    Double4 g0 = load4(p.free_gap_m + i), g1 = load4(p.free_gap_m + i + 4), g2 = load4(p.free_gap_m + i + 8),
            g3 = load4(p.free_gap_m + i + 12);
    for (std::int32_t k = 0; k < count; ++k) {  // bound: kMaxContacts
      const double* from = p.compliance[pushing[k]] + i;
      const Double4 s = splat4(p.push_N[pushing[k]]);
      g0 += load4(from) * s;
      g1 += load4(from + 4) * s;
      g2 += load4(from + 8) * s;
      g3 += load4(from + 12) * s;
    }
    store(p.gap_m + i, g0);
    store(p.gap_m + i + 4, g1);
    store(p.gap_m + i + 8, g2);
    store(p.gap_m + i + 12, g3);
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

// Factorises M over the active contacts; false when it is not positive definite.
bool factorise_active(NormalProblem& p, const bool (&is_active)[kMaxContacts]) PALPATE_RT {
  p.factor.n = 0;
  for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMaxContacts
    if (is_active[i]) p.active[p.factor.n++] = i;
  }
  gather_active(p);
  p.vectors += p.factor.n * (p.factor.n + 8) * (p.factor.n + 8) / 24;
  p.factored = factorise(p.factor) ? 1 : 0;
  return p.factored != 0;
}

// Adds contact i to the factor as its last unknown.
bool append_contact(NormalProblem& p, std::int32_t i) PALPATE_RT {
  ContactFactor& factor = p.factor;
  const std::int32_t n = factor.n;
  alignas(32) double row[kContactStride];
  for (std::int32_t k = 0; k < whole_lanes(n, 4); ++k) {  // bound: kMaxContacts
    row[k] = k < n && p.active[k] >= 0 ? p.compliance[p.active[k]][i] : 0.0;
  }
  p.vectors += n * (n + 16) / 8;
  solve_lower(factor, row);
  double rest = p.compliance[i][i];
  for (std::int32_t k = 0; k < n; ++k) {  // bound: kMaxContacts
    factor.column[k][n] = row[k];
    rest -= row[k] * row[k];
  }
  if (!(rest > 1e-13 * p.compliance[i][i] && rest < kHuge * kHuge)) return false;
  const std::int32_t first = n / 4 * 4;
  for (std::int32_t k = first; k < first + 4; ++k) factor.column[n][k] = 0;  // bound: 4
  if (n == first) {  // a new vector of rows: what follows the new row is zero
    for (std::int32_t k = 0; k < n; ++k)
      for (std::int32_t r = n + 1; r < n + 4; ++r) factor.column[k][r] = 0;  // bound: 3 kMaxContacts
  }
  factor.column[n][n] = square_root(rest);
  factor.inverse_pivot[n] = 1.0 / factor.column[n][n];
  p.active[n] = i;
  factor.n = n + 1;
  return true;
}

// Exchanges dearer than this many updates of the factor are cheaper as a new one.
constexpr std::int32_t kMostUpdates = 8;

// Carries the exchanges over to the factor. False when it has to be made anew.
bool update_factor(NormalProblem& p, const bool (&is_active)[kMaxContacts],
                   const bool (&flips)[kMaxContacts]) PALPATE_RT {
  std::int32_t changes = 0, joins = 0;
  for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMaxContacts
    if (!flips[i]) continue;
    changes += 1;
    joins += is_active[i] ? 1 : 0;
  }
  if (changes > kMostUpdates || p.factor.n + joins > kMaxContacts) return false;
  for (std::int32_t k = 0; k < p.factor.n; ++k) {  // bound: kMostUpdates updates
    const std::int32_t i = p.active[k];
    if (i < 0 || !flips[i]) continue;
    p.vectors += (p.factor.n - k) * (p.factor.n - k + 24) / 4;
    remove_unknown(p.factor, k);
    p.active[k] = -1;
  }
  for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMostUpdates updates
    if (flips[i] && is_active[i] && !append_contact(p, i)) return false;
  }
  return true;
}

// The whole vector lanes past n hold zeros, so that they take part in sums harmlessly.
void pad(NormalProblem& p) PALPATE_RT {
  for (std::int32_t i = p.n; i < whole_lanes(p.n, 4); ++i) {  // bound: 3
    p.free_gap_m[i] = p.push_N[i] = p.gap_m[i] = 0;
    for (std::int32_t j = 0; j < p.n; ++j) p.compliance[j][i] = 0;  // bound: kMaxContacts
  }
}

void measure_residual(NormalProblem& p) PALPATE_RT {
  p.residual_m = 0;
  for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMaxContacts
    const double push_m = p.push_N[i] * p.compliance[i][i];
    const double wrong = abs_of(push_m < p.gap_m[i] ? push_m : p.gap_m[i]);
    if (!(wrong <= p.residual_m)) p.residual_m = wrong;
  }
}

// The solution, without the pull that the tolerance lets pass.
void settle(NormalProblem& p) PALPATE_RT {
  bool pulls = false;
  for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMaxContacts
    pulls = pulls || !(p.push_N[i] >= 0);
    p.push_N[i] = max_of(p.push_N[i], 0.0);
  }
  if (pulls) add_gaps(p);
  measure_residual(p);
}

}  // namespace

void measure_gaps(NormalProblem& p) PALPATE_RT {
  pad(p);
  add_gaps(p);
  measure_residual(p);
}

void solve_sweeping(NormalProblem& p, std::int32_t sweeps) PALPATE_RT {
  p.factored = 0;
  for (std::int32_t i = 0; i < p.n; ++i) p.push_N[i] = max_of(p.push_N[i], 0.0);  // NaN becomes 0
  pad(p);
  add_gaps(p);
  const std::int32_t rows = whole_lanes(p.n, 4);
  p.vectors += sweeps * p.n * 4;
  for (std::int32_t sweep = 0; sweep < sweeps; ++sweep) {  // bound: 100, from the image
    for (std::int32_t j = 0; j < p.n; ++j) {               // bound: kMaxContacts
      const double next = max_of(p.push_N[j] - p.gap_m[j] / p.compliance[j][j], 0.0);
      const double step = next - p.push_N[j];
      if (step == 0) continue;
      p.push_N[j] = next;
      p.vectors += rows / 4;
      const Double4 s = splat4(step);
      for (std::int32_t i = 0; i < rows; i += 4)
        store(p.gap_m + i, load4(p.gap_m + i) + load4(p.compliance[j] + i) * s);
    }
  }
  measure_gaps(p);
}

namespace {

// Exchanges until every contact is on its right side, from an active set whose factor may be at hand.
void pivot(NormalProblem& p, bool (&is_active)[kMaxContacts], bool fits, std::int32_t most) PALPATE_RT {
  double largest_m = 0;
  for (std::int32_t i = 0; i < p.n; ++i) largest_m = max_of(largest_m, abs_of(p.free_gap_m[i]));  // bound: kMaxContacts
  const double tolerance_m = 1e-10 * largest_m;
  std::int32_t best = p.n + 1, patience = 3;
  for (std::int32_t round = 0; round < most; ++round) {  // bound: kMaxPivots
    p.pivots += 1;
    if (!fits && !factorise_active(p, is_active)) break;
    close_active(p);
    add_gaps(p);
    const Exchange exchange = find_wrong(p, is_active, tolerance_m);
    if (exchange.count == 0) return settle(p);
    // All at once while that makes progress; otherwise the last one only, which always ends (Murty 1974).
    if (exchange.count < best) {
      best = exchange.count;
      patience = 3;
    } else {
      patience -= 1;
    }
    bool flips[kMaxContacts];
    for (std::int32_t i = 0; i < p.n; ++i) {  // bound: kMaxContacts
      flips[i] = exchange.wrong[i] && (patience >= 0 || i == exchange.last);
      if (flips[i]) is_active[i] = !is_active[i];
    }
    fits = update_factor(p, is_active, flips);
  }
  solve_sweeping(p, kFallbackSweeps);
}

}  // namespace

void solve_pivoting(NormalProblem& p) PALPATE_RT {
  pad(p);
  bool is_active[kMaxContacts];
  for (std::int32_t i = 0; i < p.n; ++i) is_active[i] = p.push_N[i] > 0;  // bound: kMaxContacts
  p.pivots = 0;
  pivot(p, is_active, false, kMaxPivots);
}

void resolve_pivoting(NormalProblem& p) PALPATE_RT {
  bool is_active[kMaxContacts] = {};
  for (std::int32_t k = 0; k < p.factor.n; ++k) {  // bound: kMaxContacts
    if (p.active[k] >= 0) is_active[p.active[k]] = true;
  }
  pivot(p, is_active, true, kMaxPivots);
}

}  // namespace palpate
