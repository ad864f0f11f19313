// Whether the hand felt what the scene says: shares of ticks, each with a limit. docs/exit_codes.md has the table.
#pragma once

#include <string>
#include <vector>

#include "sim_host/run/run_session.h"
#include "sim_host/run/run_summary.h"

namespace CLI {
class App;
}

namespace palpate {

// Shares, 0 to 1; the reasons for the numbers are in docs/exit_codes.md.
struct VerdictLimits {
  double armed = 0.5;   // at least
  double stale = 0.01;  // at most, as all others
  double unconverged = 0.01;
  double clamped = 0.1;
  double lost = 0;
  double work = 0;
};

struct RunVerdict {
  const char* name;
  double share;
  double limit;
  bool at_least;  // the limit is a lower one
  std::string meaning;
  bool ok() const { return at_least ? share >= limit : share <= limit; }
};

struct RunFacts {
  std::uint64_t lost = 0;    // records
  bool wants_force = true;   // false: never to be armed, or interrupted before it was
  bool interrupted = false;  // by the user: perhaps before it was armed
};

std::vector<RunVerdict> judge(const RunSummary& summary, const RunFacts& facts, const VerdictLimits& limits);
// Of presses and grasps.
RunVerdict judge_unconverged(std::uint64_t unconverged, std::uint64_t ticks, const VerdictLimits& limits);
bool all_ok(const std::vector<RunVerdict>& verdicts);
// The gravest thing that happened.
int exit_code_of(const RunResult& result, const std::vector<RunVerdict>& verdicts);
// One line each.
std::string verdict_text(const std::vector<RunVerdict>& verdicts);

// Adds --allow NAME=PERCENT for those `names` of verdicts.
void add_allow_option(CLI::App& command, VerdictLimits& limits, const std::vector<std::string>& names);

}  // namespace palpate
