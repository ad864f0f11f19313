// The frictionless contact problem (Signorini): gaps w = q + M f >= 0, pushes f >= 0, w . f = 0, with M symmetric
// positive definite. Solved exactly by block principal pivoting (Kostreva 1978; Judice & Pires 1994), or approximately
// by projected Gauss-Seidel.
#pragma once

#include "rt_core/contact/nodes/factor.h"

namespace palpate {

// Exchanges of the active set. Warm-started problems of a sliding sphere need at most 3, cold ones 6 (measured on
// finite-element compliances); past the cap projected Gauss-Seidel finishes: Status::kNotConverged if it cannot.
inline constexpr std::int32_t kMaxPivots = 8;
inline constexpr std::int32_t kFallbackSweeps = 20;

struct NormalProblem {
  alignas(32) double compliance[kMaxContacts][kContactStride];  // M, m/N; rows and columns from n on are not read
  alignas(32) double free_gap_m[kContactStride];                // q
  alignas(32) double push_N[kContactStride];                    // in: a guess (its positive entries are the first
                                                                // active set); out: f
  alignas(32) double gap_m[kContactStride];                     // out: w
  ContactFactor factor;                                         // out: of M over the active set, when `factored`
  std::int32_t active[kMaxContacts];                            // out: contacts of the factor, in order; -1: taken out
  std::int32_t n = 0;
  std::int32_t factored = 0;
  std::int32_t pivots = 0;   // active sets tried
  std::int32_t vectors = 0;  // of four multiplied and added since gather_normal(), as Work counts them
  double residual_m = 0;     // largest |min(f M_ii, w)|
};

// Solves by pivoting. Bound: kMaxPivots factorisations, then kFallbackSweeps sweeps.
void solve_pivoting(NormalProblem& problem) PALPATE_RT;
// Solves again for other free gaps, from the factor at hand (`factored`) and its active set.
void resolve_pivoting(NormalProblem& problem) PALPATE_RT;
// Sweeps from the guess, f_i <- max(0, f_i - w_i / M_ii).
void solve_sweeping(NormalProblem& problem, std::int32_t sweeps) PALPATE_RT;
// w = q + M f and the residual.
void measure_gaps(NormalProblem& problem) PALPATE_RT;

}  // namespace palpate
