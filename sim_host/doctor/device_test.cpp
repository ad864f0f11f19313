#include "sim_host/doctor/device_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hal/bus/link_report.h"
#include "hal/loop/link_watch.h"

namespace palpate {
namespace {

// Ticks a device may take to show what a command did: the lag that the loop lets pass.
constexpr int kAnswer_ticks = static_cast<int>(LinkLimits{}.lag_ticks);
// From the last command to flag 16: 20 ms by the protocol, and what sample and bus may take on top.
constexpr int kWatchdogEarliest_ticks = 10, kWatchdogLatest_ticks = 30;
constexpr std::uint32_t kOff = 0, kOn = CommandFlag::kEnable;

}  // namespace

DeviceTest::DeviceTest(Transport& transport, WireProfile profile, int node, std::function<void()> wait)
    : transport_(transport), profile_(profile), node_(node), wait_(std::move(wait)), bus_(transport, profile, node) {}

void DeviceTest::row(const char* name, bool good, std::string found, const char* remedy) {
  rows_.push_back({name, good ? Verdict::kPass : Verdict::kFail, std::move(found), good ? "" : remedy});
}

void DeviceTest::row_unknown(const char* name, const char* found) {
  rows_.push_back({name, Verdict::kUnknown, found, ""});
}

void DeviceTest::send(std::uint32_t sequence, std::uint32_t flags, Spoil spoil) {
  wire::Command header;
  header.sequence = sequence & 0xFFFFu;
  header.flags = flags;
  const int node = spoil == Spoil::kNode ? (node_ == wire::kMaxNode ? node_ - 1 : node_ + 1) : node_;
  Frame frames[2];
  const int count = make_command_frames(profile_, node, header, {}, frames);
  for (Frame& frame : frames) {
    if (spoil == Spoil::kChecksum) frame.data[1] ^= 0x10;
    if (spoil == Spoil::kLength) frame.length = frame.fd ? 16 : 7;
  }
  transport_.send({frames, static_cast<std::size_t>(count)});
}

void DeviceTest::listen(int count) {
  for (int i = 0; i < count; ++i) {
    wait_();
    bus_.receive(sample_);
  }
}

void DeviceTest::tick(std::uint32_t flags) {
  listen(1);
  sent_before_ = sequence_;
  send(++sequence_, flags);
}

void DeviceTest::ticks(int count, std::uint32_t flags) {
  for (int i = 0; i < count; ++i) tick(flags);
}

bool DeviceTest::echoes(std::uint32_t sequence) const {
  const std::uint32_t mask = profile_ == WireProfile::kFd ? 0xFFFFu : wire::kClassicEchoMask;
  return ((sequence - bus_.obeyed_sequence()) & mask) <= LinkLimits{}.lag_ticks;
}

bool DeviceTest::until(bool (DeviceTest::*reached)() const, int most_ticks, std::uint32_t flags) {
  for (int i = 0; i < most_ticks; ++i) {
    tick(flags);
    if ((this->*reached)()) return true;
  }
  return false;
}

bool DeviceTest::wait_for_samples() {
  constexpr int kLongest_ticks = 3000;
  for (int i = 0; i < kLongest_ticks && bus_.counters().accepted == 0; ++i) tick(kOff);
  if (bus_.counters().accepted > 0) return true;
  const LinkReport report = report_link(bus_, transport_.state());
  rows_.push_back({"samples arrive", Verdict::kFail, report.found, report.remedy});
  return false;
}

void DeviceTest::test_samples() {
  constexpr int kTicks = 500;
  const BusCounters before = bus_.counters();
  int silence = 0, longest = 0;
  for (int i = 0; i < kTicks; ++i) {
    tick(kOff);
    silence = sample_.fresh ? 0 : silence + 1;
    longest = std::max(longest, silence);
  }
  const BusCounters& now = bus_.counters();
  const auto came = static_cast<int>(now.accepted - before.accepted);
  row("samples arrive", came > kTicks * 9 / 10 && came < kTicks * 11 / 10 && longest <= 5,
      fmt::format("{} in {} ms, longest silence {} ms", came, kTicks, longest),
      "send one status per period of 1 ms, whether commands come or not");
  const std::uint64_t lost = now.lost - before.lost, again = now.duplicates - before.duplicates,
                      old = now.reordered - before.reordered, jumps = now.restarts - before.restarts;
  row("samples are numbered in order", lost + again + old + jumps == 0,
      fmt::format("{} missing, {} twice, {} out of order, {} jumps", lost, again, old, jumps),
      "count the sequence number up by 1 with every status, and send each once, in order");
  const LinkReport report = report_link(bus_, transport_.state());
  const bool formed = bus_.first_reason() == DropReason::kNone || bus_.first_reason() == DropReason::kOrientation;
  row("frames are well formed", formed && now.unpaired == before.unpaired, report.found, report.remedy.c_str());
  row("orientation is a rotation", now.orientation == 0, fmt::format("{} are not", now.orientation),
      "send the handle's unit quaternion; without a sense of orientation 32767 0 0 0");
  if (profile_ == WireProfile::kClassic) return row_unknown("device clock runs", "classic frames carry no time");
  row("device clock runs", now.clock == before.clock, fmt::format("{} steps not forward", now.clock - before.clock),
      "DeviceTime counts microseconds and never goes back but by wrapping");
}

void DeviceTest::test_flags() {
  row("calibrated", has(DeviceFlag::kCalibrated), "flags: " + device_flag_names(bus_.newest().flags),
      "set flag 1 once positions are absolute; the controller does not arm before");
  row("no error, no emergency stop", !has(DeviceFlag::kError | DeviceFlag::kStopButton),
      fmt::format("flags: {}, code {}", device_flag_names(bus_.newest().flags), bus_.newest().error_code),
      "release the stop, clear the error");
  row("drives are off unless enabled", disabled(), "flags: " + device_flag_names(bus_.newest().flags),
      "flag 2 says that drives are powered: only while enabled");
}

void DeviceTest::test_echo() {
  std::uint32_t late = 0;
  constexpr int kTicks = 200;
  const std::uint32_t first = bus_.obeyed_sequence();
  for (int i = 0; i < kTicks; ++i) {
    tick(kOff);
    late += !heard();
  }
  row("echoes the command it obeys", late == 0 && bus_.obeyed_sequence() != first,
      fmt::format("{} of {} statuses more than {} commands behind", late, kTicks, kAnswer_ticks),
      "put the number of the newest command obeyed into CommandSequence (classic: CommandEcho) of every status");
}

void DeviceTest::test_lost_commands() {
  constexpr std::uint32_t kLost = 40;  // more than the lag that heard() lets pass
  sequence_ += kLost;
  row("follows after lost commands", until(&DeviceTest::heard, kAnswer_ticks, kOff),
      fmt::format("{} numbers left out", kLost), "a number up to half the range ahead is loss: obey it");
  // Five commands late, then all at once and the newest first.
  listen(5);
  for (std::uint32_t i = 5; i > 0; --i) send(sequence_ + i, kOff);
  sequence_ += 5;
  listen(3);
  row("obeys the newest of a burst",
      bus_.obeyed_sequence() ==
          (profile_ == WireProfile::kFd ? sequence_ & 0xFFFFu : sequence_ & wire::kClassicEchoMask),
      "5 commands at once, the newest first", "drain all that arrived and keep the newest number; drop the older ones");
}

void DeviceTest::test_old_commands() {
  ticks(5, kOff);
  listen(3);
  const std::uint32_t newest = bus_.obeyed_sequence();
  bool moved = false;
  for (const std::uint32_t back : {0u, 7u, 3u}) {
    send(sequence_ - back, kOff);
    listen(3);
    moved = moved || bus_.obeyed_sequence() != newest;
  }
  ticks(5, kOff);
  row("refuses repeated and old commands", !moved, moved ? "the echo went back" : "the echo stayed",
      "equal numbers are duplicates, numbers up to a quarter of the range behind are old: drop both");
}

void DeviceTest::test_spoiled_commands() {
  const std::pair<Spoil, const char*> kinds[] = {{Spoil::kChecksum, "refuses a wrong checksum"},
                                                 {Spoil::kLength, "refuses a wrong length"},
                                                 {Spoil::kNode, "refuses another node's command"}};
  for (const auto& [spoil, name] : kinds) {
    ticks(10, kOff);
    listen(3);
    const std::uint32_t newest = bus_.obeyed_sequence();
    for (int i = 0; i < 5; ++i) {
      send(++sequence_, kOff, spoil);
      listen(1);
    }
    listen(2);
    const bool same = bus_.obeyed_sequence() == newest;
    row(name, same, same ? "the echo stayed" : "it was obeyed",
        "check length, identifier and checksum of every command before using it");
  }
}

void DeviceTest::test_enable_edge() {
  ticks(10, kOff);
  const bool on = until(&DeviceTest::enabled, kAnswer_ticks, kOn);
  row("enables on 0 -> 1", on, "flags: " + device_flag_names(bus_.newest().flags),
      "power the drives when enable goes from 0 to 1; then set flag 2 and clear flag 16");
  const bool off = until(&DeviceTest::disabled, kAnswer_ticks, kOff);
  row("disables on 0", on && off, "flags: " + device_flag_names(bus_.newest().flags),
      "without enable: zero force, flag 2 cleared");
}

void DeviceTest::test_watchdog() {
  ticks(5, kOff);
  ticks(20, kOn);
  int let_go = 0;
  for (int i = 1; i <= 60; ++i) {
    listen(1);
    if (let_go == 0 && has(DeviceFlag::kWatchdog)) let_go = i;
  }
  row("lets go without commands", let_go >= kWatchdogEarliest_ticks && let_go <= kWatchdogLatest_ticks,
      let_go > 0 ? fmt::format("flag 16 after {} ms", let_go) : "flag 16 did not come in 60 ms",
      "20 ms without a valid new command: zero force, flag 16 set, flag 2 cleared");
  ticks(50, kOn);
  row("stays so until enabled anew", has(DeviceFlag::kWatchdog) && disabled(),
      "50 commands with enable; flags: " + device_flag_names(bus_.newest().flags),
      "latch the watchdog: commands alone must not bring the force back");
  ticks(10, kOff);
  row("is enabled anew by 0 -> 1", until(&DeviceTest::enabled, kAnswer_ticks, kOn),
      "flags: " + device_flag_names(bus_.newest().flags), "an enable that goes from 0 to 1 ends the latch");
  ticks(10, kOff);
}

void DeviceTest::test_restart() {
  sequence_ = 0;
  ticks(kAnswer_ticks, kOff);
  const bool soon = heard();
  ticks(25, kOff);  // an echo that stands still cannot be near both, whatever its six bits are
  row("follows a controller that starts again", soon && heard(), "numbers from 1 again",
      "four old numbers that follow one another are a new sender: obey it");
}

std::vector<DoctorItem> DeviceTest::run() {
  rows_.clear();
  if (wait_for_samples()) {
    test_samples();
    test_flags();
    test_echo();
    test_lost_commands();
    test_old_commands();
    test_spoiled_commands();
    test_enable_edge();
    test_watchdog();
    test_restart();
  }
  ticks(5, kOff);
  return rows_;
}

}  // namespace palpate
