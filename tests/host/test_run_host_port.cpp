// What the controller makes of its host: commands, a dead host, a host that writes garbage.
#include <gtest/gtest.h>

#include <new>

#include "sim_host/run/host_port.h"

namespace palpate {
namespace {

struct Host {
  MailboxRegion region{};
  MailboxWriter writer{region};
  std::atomic<bool> stop{false}, interrupted{false};
  HostPort port{&region, 10, interrupted, stop};
};

// As a service started at boot it armed by itself, whoever held the handle (2026-11-21).
TEST(HostPort, WithoutAHostItRunsButArmsOnlyWhenAnOperatorAsks) {
  std::atomic<bool> stop{false}, interrupted{false};
  std::atomic<std::uint32_t> requests{0};
  HostPort port(nullptr, 10, interrupted, stop);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(port.poll(), 0u);
  port.arm_on(requests);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(port.poll(), 0u);
  requests += 1;
  int edges = 0;
  std::uint32_t before = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t commands = port.poll();
    edges += commands == Command::kArm && before == 0 ? 1 : 0;
    EXPECT_EQ(commands & ~Command::kArm, 0u);
    before = commands;
  }
  EXPECT_GT(edges, 10) << "a tick without a fresh sample ignores an edge";
  EXPECT_LE(edges, 100) << "and the request does not stand for ever";
  EXPECT_EQ(before, 0u);
  EXPECT_EQ(port.faults(), 0u);
  EXPECT_FALSE(stop);
  interrupted = true;
  port.poll();
  EXPECT_TRUE(stop);
}

TEST(HostPort, PassesLevelsOnAndQuitsWhenAsked) {
  Host host;
  host.writer.set(Command::kArm, false);
  EXPECT_EQ(host.port.poll(), Command::kArm);
  EXPECT_EQ(host.port.poll(), Command::kArm);
  host.writer.set(Command::kStop, false);
  EXPECT_EQ(host.port.poll(), Command::kStop);
  EXPECT_FALSE(host.stop);
  host.writer.set(Command::kStop, true);
  EXPECT_EQ(host.port.poll(), Command::kStop);
  EXPECT_TRUE(host.stop);
  EXPECT_EQ(host.port.faults(), 0u);
}

TEST(HostPort, AHostWhoseHeartbeatStopsIsAFault) {
  Host host;
  host.writer.set(Command::kArm, false);
  for (int i = 0; i < 100; ++i) {  // beats in time, however long it lasts
    if (i % 5 == 0) host.writer.beat();
    host.port.poll();
  }
  EXPECT_EQ(host.port.faults(), 0u);
  for (int i = 0; i < 10; ++i) host.port.poll();
  EXPECT_EQ(host.port.faults(), Fault::kHostSilent);
  EXPECT_TRUE(host.stop);
  host.writer.beat();  // coming back does not undo it
  host.port.poll();
  EXPECT_EQ(host.port.faults(), Fault::kHostSilent);
}

TEST(HostPort, AHostThatHasEndedIsAFaultAtOnce) {
  Host host;
  host.writer.set(Command::kArm, false);
  host.port.poll();
  EXPECT_EQ(host.port.faults(), 0u);
  host.port.host_has_died();
  host.port.poll();
  EXPECT_EQ(host.port.faults(), Fault::kHostSilent);
  EXPECT_TRUE(host.stop);
}

TEST(HostPort, GarbageIsAFaultAndTheLastCommandStands) {
  Host host;
  host.writer.set(Command::kArm, false);
  EXPECT_EQ(host.port.poll(), Command::kArm);
  host.region.word[1].store(~0ull);
  EXPECT_EQ(host.port.poll(), Command::kArm);
  EXPECT_EQ(host.port.faults(), Fault::kCommandInvalid);
  EXPECT_TRUE(host.stop);
}

struct QuietDevice {
  void receive(DeviceSample& sample) noexcept { sample.faults = Fault::kDeviceReported; }
  bool transmit(const DeviceCommand&) noexcept { return true; }
};

TEST(HostPort, FaultsOfHostAndDeviceArriveTogether) {
  Host host;
  host.writer.set(0, false);
  for (int i = 0; i < 20; ++i) host.port.poll();
  QuietDevice inner;
  SupervisedDevice device(inner, host.port);
  DeviceSample sample;
  device.receive(sample);
  EXPECT_EQ(sample.faults, Fault::kDeviceReported | Fault::kHostSilent);
}

}  // namespace
}  // namespace palpate
