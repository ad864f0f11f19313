// Faults a simulated device commits on purpose, read from text: one line per fault, `AT_S KIND [VALUE]`.
#pragma once

#include <string>
#include <vector>

namespace palpate {

// X(kind, word, value if not given, lowest, highest, what it does with its value)
#define PALPATE_DEVICE_FAULTS(X)                                                                             \
  X(kLose, "lose", 1, 1, 60000, "N samples are never sent")                                                  \
  X(kDuplicate, "duplicate", 1, 1, 60000, "N samples are sent twice")                                        \
  X(kReorder, "reorder", 1, 1, 60000, "N samples are each sent after the one that follows")                  \
  X(kDelay, "delay", 1, 1, 30, "samples wait for N ticks, then all come at once and in order")               \
  X(kCorrupt, "corrupt", 1, 1, 60000, "one bit is flipped in each of N samples, another one each time")      \
  X(kFreeze, "freeze", 0.1, 1e-3, 3600, "the position encoders stand still for S seconds")                   \
  X(kJump, "jump", 5, -1000, 1000, "the position encoder of x is off by MM millimetres from here on")        \
  X(kSequence, "sequence", 0, 0, 0, "sample numbers start again from zero")                                  \
  X(kRestart, "restart", 0.01, 1e-3, 3600, "without power for S seconds, then numbers and clock start anew") \
  X(kDrift, "drift", 0, -50000, 50000, "the device's clock runs PPM parts per million fast from here on")    \
  X(kBusOff, "bus-off", 0, 0, 0, "an error frame says that the controller's chip left the bus")              \
  X(kUnplug, "unplug", 0.1, 1e-3, 3600, "the transport is closed, and opened again after S seconds")         \
  X(kSilence, "silence", 0.1, 1e-3, 3600, "the device works but sends nothing for S seconds")                \
  X(kMiss, "miss", 1, 1, 60000, "commands of N ticks never reach it")                                        \
  X(kGarble, "garble", 1, 1, 60000, "one bit is flipped in each command it receives for N ticks")            \
  X(kDeaf, "deaf", 0.1, 1e-3, 3600, "it works and sends, but no command reaches it for S seconds")           \
  X(kStop, "stop", 0.1, 1e-3, 3600, "its emergency stop is pressed for S seconds")

enum class DeviceFault : int {
#define PALPATE_KIND(kind, word, value, lowest, highest, what) kind,
  PALPATE_DEVICE_FAULTS(PALPATE_KIND)
#undef PALPATE_KIND
};

struct FaultLine {
  double at_s = 0;  // device time since its start
  DeviceFault fault = DeviceFault::kLose;
  double value = 0;
};

// Reads a script; '#' begins a comment. Lines come out sorted by time (equal times in the order written). False:
// `error` names the line and what is allowed there.
bool parse_fault_script(const std::string& text, std::vector<FaultLine>& lines, std::string& error);

// One line per kind, for --help and documentation.
std::string fault_script_help();

}  // namespace palpate
