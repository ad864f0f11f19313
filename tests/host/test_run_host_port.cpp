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

TEST(HostPort, WithoutAHostItArmsAndRunsOn) {
  std::atomic<bool> stop{false}, interrupted{false};
  HostPort port(nullptr, 10, interrupted, stop);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(port.poll(), Command::kArm);
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
