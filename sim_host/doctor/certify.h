// The long run that certifies a machine: the real controller and the real (or simulated) device for hours, never armed,
// so that the force stays zero while every stage computes; then a dated result with the machine's identity.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim_host/latency/machine_identity.h"
#include "sim_host/run/run_session.h"

namespace palpate {

struct CertifyLimits {
  double busy_share = 0.5;  // of the period, for the longest tick, wake-up included
  double wake_us = 0;       // latest wake-up; 0: not limited by itself
};

struct CertifyOptions {
  double duration_s = 3600;
  std::string scene;                // .toml or .pal; empty: a ball pressed and stroked, built in
  std::string path;                 // CSV of the simulated hand; empty: the scene's own, repeated
  std::string device = "loopback";  // as for palpate run
  std::string profile;              // of the device, as for palpate run
  int cpu = -1, priority = 80;
  bool host_load = false;  // load made here; otherwise the load is the user's
  CertifyLimits limits;
  std::string out;             // prefix of the two result files
  std::string program_folder;  // as in RunOptions
  std::function<void(const LiveState&)> progress;
};

enum class CertifyVerdict { kPass, kFail, kIncomplete };

struct HostCertificate {
  CertifyVerdict verdict = CertifyVerdict::kFail;
  std::vector<std::string> reasons;  // what exceeded which limit
  MachineIdentity machine;
  CertifyOptions options;
  RunResult run;
  std::int64_t period_ns = 1'000'000;
  std::int64_t start_s = 0, end_s = 0;  // since 1970
};

// Runs it. SIGINT and SIGTERM end it early and keep what was measured. Throws std::runtime_error when it cannot start.
HostCertificate certify(const CertifyOptions& options);
// Verdict and reasons from the other members: any limit exceeded fails; an early end without that is incomplete.
void judge(HostCertificate& certificate);

std::string certificate_text(const HostCertificate& certificate);
std::string certificate_json(const HostCertificate& certificate);
// "palpate-latency-HOST-20261121T040145Z".
std::string certificate_name(const std::string& host, std::int64_t seconds_since_1970);

}  // namespace palpate
