// `palpate device-test`: does a device keep the wire protocol's rules? It takes the controller's place with zero force,
// loses, repeats, spoils and withholds commands, and grades what the device says of it, one row a rule.
#pragma once

#include <functional>
#include <vector>

#include "hal/bus/device_bus.h"
#include "sim_host/doctor/doctor.h"

namespace palpate {

class DeviceTest {
 public:
  // `transport` must outlive this. `wait` lets one period of the device (1 ms) pass; tests let virtual time pass there.
  DeviceTest(Transport& transport, WireProfile profile, int node, std::function<void()> wait);

  // Every row, in the order of docs/wire_protocol.md; it ends early when no sample comes. Takes 2 s of device time. The
  // last commands are zero force, drives off; no command ever carries a force.
  std::vector<DoctorItem> run();

 private:
  // One period: wait, receive, then send the next command with `flags`.
  void tick(std::uint32_t flags);
  void listen(int ticks);  // sends nothing
  void ticks(int count, std::uint32_t flags);
  enum class Spoil { kNone, kChecksum, kLength, kNode };
  void send(std::uint32_t sequence, std::uint32_t flags, Spoil spoil = Spoil::kNone);
  bool echoes(std::uint32_t sequence) const;
  bool has(std::uint32_t flag) const { return (bus_.newest().flags & flag) != 0; }
  bool until(bool (DeviceTest::*reached)() const, int most_ticks, std::uint32_t flags);
  bool heard() const { return echoes(sent_before_); }
  bool enabled() const { return has(DeviceFlag::kEnabled) && !has(DeviceFlag::kWatchdog); }
  bool disabled() const { return !has(DeviceFlag::kEnabled); }

  bool wait_for_samples();
  void test_samples();
  void test_flags();
  void test_echo();
  void test_lost_commands();
  void test_old_commands();
  void test_spoiled_commands();
  void test_enable_edge();
  void test_watchdog();
  void test_restart();
  void row(const char* name, bool good, std::string found, const char* remedy);
  void row_unknown(const char* name, const char* found);

  Transport& transport_;
  WireProfile profile_;
  int node_;
  std::function<void()> wait_;
  DeviceBus bus_;
  DeviceSample sample_;
  std::uint32_t sequence_ = 0;     // newest sent
  std::uint32_t sent_before_ = 0;  // newest sent in the tick before
  std::vector<DoctorItem> rows_;
};

}  // namespace palpate
