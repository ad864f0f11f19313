// One run from start to summary: bake if needed, start the controller (and the simulated device), arm, watch, record,
// stop in order.
#pragma once

#include <string>

#include "sim_host/run_summary.h"

namespace palpate {

struct RunOptions {
  std::string scene;            // .toml or .pal
  std::string device = "auto";  // auto, loopback, can:IFACE
  double duration_s = 10;
  std::string record = "run.plr";  // empty: do not record
  std::string path;                // CSV of the simulated hand's motion; empty: the scene's own
  std::string image;               // where to write the image of a .toml scene; empty: beside the recording
  int cpu = -1;                    // of the real-time thread; -1: any
  int priority = 80;               // SCHED_FIFO; 0: ordinary scheduling
  bool quiet = false;              // no live status line
  std::string program_folder;      // of palpate-rt and palpate-device; empty: beside this program
};

struct RunResult {
  RunSummary summary;
  std::uint64_t lost = 0;
  int controller_exit = 0;
  std::string recorder_error;
  bool interrupted = false;  // Ctrl-C
  bool faulted() const { return summary.fault != 0; }
};

// Throws std::runtime_error when the run cannot start. SIGINT and SIGTERM end it early and in order.
RunResult run_session(const RunOptions& options);

}  // namespace palpate
