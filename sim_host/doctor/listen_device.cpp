#include <fmt/format.h>

#include <memory>

#include "hal/bus/device_address.h"
#include "hal/bus/link_report.h"
#include "hal/device/device_profile.h"
#include "hal/loop/clock.h"
#include "hal/system/device_lock.h"
#include "rt_core/limits.h"
#include "sim_host/doctor/doctor.h"

namespace palpate {

namespace {

// Whether scenes of 1 kHz would be rendered (Fault::kSamplesSparse).
DoctorItem judge_rate(double samples_Hz) {
  constexpr double kUsual_Hz = 1000;
  const bool enough = samples_Hz >= (1 - kStaleShareMost) * kUsual_Hz;
  return {
      "samples", enough ? Verdict::kPass : Verdict::kFail,
      fmt::format("{:.0f} a second, {:.0f} % of what a scene of 1 kHz asks", samples_Hz, 100 * samples_Hz / kUsual_Hz),
      enough ? ""
             : fmt::format("let the device send one a tick, or bake scenes with device.period_ms = {:.3g}",
                           1e3 / samples_Hz)};
}

}  // namespace

std::vector<DoctorItem> listen_to_device(const std::string& device, const std::string& profile) {
  std::string line, error;
  const std::optional<DeviceProfile> known = profile.empty() ? std::nullopt : read_device_profile(profile, error);
  if (known && known->arm)
    return {{"drives", Verdict::kUnknown, "not asked: drives may keep silent until they are spoken to",
             "palpate device-test " + device + " --profile " + profile + "   (finds each; enables none)"}};
  const std::optional<DeviceAddress> address = parse_device_address(device, line, error);
  if (!address || (address->kind == TransportKind::kLoopback && address->name == DeviceAddress{}.name)) return {};
  DeviceLock lock;
  if (const std::string name = lock_name(*address); !name.empty()) {
    lock = DeviceLock::take(name, error);
    if (!lock) return {{"device answers", Verdict::kUnknown, error, "ask again when nothing drives it"}};
  }
  constexpr int kTimeout_ms = 2000;
  const std::unique_ptr<Transport> transport = open_transport(*address, DeviceSide::kObserver, kTimeout_ms, error);
  if (!transport) return {{"device answers", Verdict::kFail, error, "palpate device-test says more once it opens"}};
  DeviceBus bus(*transport, address->profile, address->node);
  DeviceSample sample;
  MonotonicClock clock;
  constexpr int kPeriods = 1000;
  const std::int64_t begin_ns = clock.now_ns();
  for (int i = 0; i < kPeriods; ++i) {
    clock.wait_until(clock.now_ns() + 1'000'000);
    bus.receive(sample);
  }
  const LinkReport report = report_link(bus, transport->state());
  const auto accepted = static_cast<double>(bus.counters().accepted);
  std::vector<DoctorItem> items{
      {"device answers", report.good ? Verdict::kPass : Verdict::kFail, report.found, report.remedy}};
  if (report.good) items.push_back(judge_rate(accepted / (1e-9 * static_cast<double>(clock.now_ns() - begin_ns))));
  return items;
}

}  // namespace palpate
