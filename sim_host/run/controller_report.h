// What the controller says at its end, on stderr.
#pragma once

#include <cstdio>

#include "hal/bus/device_bus.h"
#include "hal/bus/link_report.h"
#include "hal/loop/loop.h"

namespace palpate {

// Always how far commands lagged; what arrived and what to do where something was wrong with it.
inline void print_link(const LoopSummary& summary, const DeviceBus& bus, TransportState state) {
  std::fprintf(stderr, "link: commands at most %u behind, let go %u times (%llu ticks)\n", summary.worst_lag,
               summary.link_drops, static_cast<unsigned long long>(summary.unheard_ticks));
  const LinkReport report = report_link(bus, state);
  constexpr std::uint32_t kOfTheLink = Fault::kDeviceSilent | Fault::kDeviceReported | Fault::kDeviceDeaf |
                                       Fault::kNotCalibrated | Fault::kSamplesRejected | Fault::kBusOff;
  if ((summary.faults & kOfTheLink) == 0 && report.good) return;
  std::fprintf(stderr, "device: %s%s%s\n", report.found.c_str(), report.remedy.empty() ? "" : "\n        -> ",
               report.remedy.c_str());
}

inline void print_run(const LoopSummary& summary) {
  std::fprintf(
      stderr,
      "controller: %llu ticks, %llu missed, %u stalls ridden through, %llu without a fresh sample, faults 0x%x\n",
      static_cast<unsigned long long>(summary.ticks), static_cast<unsigned long long>(summary.missed_slots),
      summary.stalls, static_cast<unsigned long long>(summary.stale_ticks), summary.faults);
  if (summary.phase_locked) {
    std::fprintf(stderr, "device clock: %+.0f ppm, followed; phase at most %.3f ms off\n", summary.device_ppm,
                 1e-6 * static_cast<double>(summary.worst_phase_ns));
  }
}

}  // namespace palpate
