// The exit codes of palpate, palpate-rt and palpate-device: one table, which docs/exit_codes.md repeats and a test
// compares.
#pragma once

#include <stdexcept>
#include <string>

namespace palpate {

// X(name, code, what happened)
#define PALPATE_EXIT_CODES(X)                                                                                       \
  X(kExitOk, 0, "it did what was asked; of a run, press or grasp: the hand felt what the scene says")               \
  X(kExitFailed, 1, "it ran, and the answer is no: a verdict failed, a replay differs, the doctor found a failure") \
  X(kExitUsage, 2, "wrong arguments, or an input file that cannot be read or is invalid")                           \
  X(kExitUnavailable, 3, "something is missing: interface, device, permission, memory, host")                       \
  X(kExitSilent, 4, "the device sent nothing at start")                                                             \
  X(kExitFault, 5, "a fault was latched, and the force ramped to zero")                                             \
  X(kExitDied, 6, "the controller or the simulated device was killed or ended by itself")                           \
  X(kExitNotRecorded, 7, "the run went well, but its recording is incomplete")

enum ExitCode : int {
#define PALPATE_CODE(name, code, meaning) name = code,
  PALPATE_EXIT_CODES(PALPATE_CODE)
#undef PALPATE_CODE
};

// An error that has an exit code of its own; any other exception ends a program with kExitUsage.
struct ExitError : std::runtime_error {
  ExitError(int exit_code, const std::string& text) : std::runtime_error(text), code(exit_code) {}
  int code;
};

}  // namespace palpate
