// Loopback, device bus, node and fault decorator: every scripted fault ends in a counted effect and never in a wrong
// sample or force.
#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "hal/bus/device_address.h"
#include "hal/bus/loopback.h"
#include "hal/bus/socketcan.h"
#include "hal/device/device_node.h"
#include "tests/hal/fault_transport.h"

namespace palpate {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

// A node and its controller side over a socket pair, stepped by hand.
struct Rig {
  explicit Rig(WireProfile profile = WireProfile::kFd, std::vector<FaultEvent> script = {})
      : pair(open_loopback_pair(error)),
        faulty(*pair.first, std::move(script)),
        bus(faulty, profile),
        node(*pair.second, {profile, 1, 20'000'000}, plant(), HandPath({{0, {{0.01, 0.02, -0.03}, {}}}})) {}
  static PlantOptions plant() {
    PlantOptions o;
    o.encoder_m = 1e-5;
    return o;
  }
  DeviceSample tick(Vec3 force_N = {}) {
    node.step(now_ns += kPeriod_ns);
    DeviceSample sample;
    bus.receive(sample);
    bus.transmit({force_N, {}, sent++ < 2 ? 0u : CommandFlag::kEnable});  // an edge, without which no force
    return sample;
  }
  int sent = 0;
  std::string error;
  std::pair<std::unique_ptr<Transport>, std::unique_ptr<Transport>> pair;
  FaultTransport faulty;
  DeviceBus bus;
  DeviceNode node;
  std::int64_t now_ns = 0;
};

class BothProfiles : public testing::TestWithParam<WireProfile> {};
INSTANTIATE_TEST_SUITE_P(Wire, BothProfiles, testing::Values(WireProfile::kFd, WireProfile::kClassic));

TEST_P(BothProfiles, SamplesAndCommandsCrossBothWays) {
  Rig rig(GetParam());
  DeviceSample sample;
  for (int i = 0; i < 5; ++i) sample = rig.tick({1.5, -2, 0.25});
  EXPECT_TRUE(sample.fresh);
  EXPECT_EQ(sample.received, 1u);
  EXPECT_NEAR(sample.position_m.z, -0.03, 3e-5);
  EXPECT_EQ(sample.flags & DeviceFlag::kEnabled, DeviceFlag::kEnabled);
  EXPECT_EQ(sample.faults, 0u);
  EXPECT_EQ(rig.node.command().force_N, (Vec3{1.5, -2, 0.25}));
  EXPECT_EQ(rig.bus.counters().accepted, 5u);
  EXPECT_EQ(rig.node.counters().commands, 4u);
  EXPECT_EQ(rig.bus.counters().lost + rig.node.counters().lost + rig.node.counters().bad, 0u);
  EXPECT_EQ(rig.bus.sent_sequence() - rig.bus.obeyed_sequence(), 1u);
  EXPECT_EQ(sample.command_lag, 0u) << "when it came, nothing newer had been sent";
  if (GetParam() == WireProfile::kFd) {
    EXPECT_EQ(sample.device_time_us, 5000u);
  }
}

TEST_P(BothProfiles, SequenceNumbersWrapWithoutLoss) {
  Rig rig(GetParam());
  const int ticks = GetParam() == WireProfile::kFd ? 65'700 : 700;
  for (int i = 0; i < ticks; ++i) rig.tick();
  EXPECT_EQ(rig.bus.counters().accepted, static_cast<std::uint64_t>(ticks));
  EXPECT_EQ(rig.bus.counters().lost + rig.bus.counters().restarts + rig.bus.counters().duplicates, 0u);
  EXPECT_EQ(rig.node.counters().refused, 0u);
}

TEST_P(BothProfiles, DrainsABacklogAndKeepsTheNewest) {
  Rig rig(GetParam());
  for (int i = 0; i < 10; ++i) rig.node.step(rig.now_ns += kPeriod_ns);
  const DeviceSample sample = rig.tick();
  EXPECT_EQ(sample.received, 11u);
  EXPECT_EQ(sample.sequence, 10u);
  EXPECT_EQ(rig.tick().received, 1u);
}

TEST_P(BothProfiles, LossIsCountedAsGaps) {
  Rig rig(GetParam(), {{10, 3, TransportFault::kLose}});
  for (int i = 0; i < 10; ++i) rig.tick();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(rig.tick().fresh);
  const DeviceSample sample = rig.tick();
  EXPECT_TRUE(sample.fresh);
  EXPECT_EQ(sample.gaps, 3u);
  EXPECT_EQ(rig.bus.counters().lost, 3u);
}

TEST_P(BothProfiles, CorruptionIsCountedAndTheLastSampleRepeated) {
  Rig rig(GetParam(), {{10, 1, TransportFault::kCorrupt, 12}});
  DeviceSample before;
  for (int i = 0; i < 10; ++i) before = rig.tick();
  const DeviceSample sample = rig.tick();
  EXPECT_FALSE(sample.fresh);
  EXPECT_EQ(sample.position_m, before.position_m);
  EXPECT_EQ(rig.bus.counters().checksum, GetParam() == WireProfile::kFd ? 1u : 2u);
}

TEST(Faults, DuplicatesAreDropped) {
  Rig rig(WireProfile::kFd, {{5, 4, TransportFault::kDuplicate}});
  for (int i = 0; i < 12; ++i) EXPECT_EQ(rig.tick().received, 1u);
  EXPECT_EQ(rig.bus.counters().duplicates, 4u);
}

TEST(Faults, ReorderedSamplesAreDroppedAndCounted) {
  Rig rig(WireProfile::kFd, {{5, 1, TransportFault::kReorder}});
  for (int i = 0; i < 5; ++i) rig.tick();
  EXPECT_FALSE(rig.tick().fresh);
  const DeviceSample sample = rig.tick();  // newer one first, the held one behind it
  EXPECT_EQ(sample.received, 1u);
  EXPECT_EQ(sample.sequence, 6u);
  EXPECT_EQ(rig.bus.counters().reordered, 1u);
  EXPECT_EQ(rig.bus.counters().lost, 1u);
}

TEST(Faults, DelayMakesSilenceThenABacklog) {
  Rig rig(WireProfile::kFd, {{5, 1, TransportFault::kDelay, 3}});
  for (int i = 0; i < 5; ++i) rig.tick();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(rig.tick().fresh);
  EXPECT_EQ(rig.tick().received, 4u);
  EXPECT_EQ(rig.bus.counters().lost, 0u);
}

TEST(Faults, ClassicHalvesThatDoNotMatchAreNotCombined) {
  std::string error;
  auto [host, device] = open_loopback_pair(error);
  DeviceBus bus(*host, WireProfile::kClassic);
  Frame a[2], b[2];
  make_status_frames(1, wire::ClassicPosition{1, {}}, wire::ClassicOrientation{1, 1, 0, 0, 0, {}}, a);
  make_status_frames(1, wire::ClassicPosition{2, {}}, wire::ClassicOrientation{2, 1, 0, 0, 0, {}}, b);
  const Frame mixed[2] = {a[0], b[1]};
  device->send(mixed);
  DeviceSample sample;
  bus.receive(sample);
  EXPECT_FALSE(sample.fresh);
  EXPECT_EQ(bus.counters().unpaired, 1u);
}

TEST(Faults, BusOffIsReportedAndStays) {
  Rig rig(WireProfile::kFd, {{5, 1, TransportFault::kBusOff}});
  for (int i = 0; i < 5; ++i) EXPECT_EQ(rig.tick().faults, 0u);
  for (int i = 0; i < 5; ++i) {
    const DeviceSample sample = rig.tick();
    EXPECT_EQ(sample.faults, Fault::kBusOff);
    EXPECT_FALSE(sample.fresh);
  }
  EXPECT_GT(rig.bus.counters().send_dropped, 0u);
}

TEST(Faults, AFullQueueDropsTheCommandAndIsCounted) {
  Rig rig(WireProfile::kFd, {{5, 2, TransportFault::kFullQueue}});
  for (int i = 0; i < 12; ++i) rig.tick({1, 0, 0});
  EXPECT_EQ(rig.bus.counters().send_dropped, 2u);
  EXPECT_EQ(rig.node.counters().lost, 2u);
}

TEST(Node, WatchdogDropsTheForceAndLatches) {
  Rig rig(WireProfile::kFd, {{10, 30, TransportFault::kLoseSent}});
  for (int i = 0; i < 12; ++i) rig.tick({1, 0, 0});
  EXPECT_EQ(rig.node.plant().motor().force_N.x, 1.0);
  DeviceSample sample;
  for (int i = 12; i < 38; ++i) sample = rig.tick({1, 0, 0});
  EXPECT_EQ(rig.node.counters().watchdog, 1u);
  EXPECT_EQ(rig.node.plant().motor().force_N, Vec3{});
  EXPECT_EQ(sample.flags & DeviceFlag::kWatchdog, DeviceFlag::kWatchdog);
  for (int i = 38; i < 60; ++i) sample = rig.tick({1, 0, 0});
  EXPECT_EQ(rig.node.plant().motor().force_N, Vec3{}) << "commands alone do not bring it back";
  EXPECT_EQ(sample.flags & (DeviceFlag::kWatchdog | DeviceFlag::kEnabled), DeviceFlag::kWatchdog);
  EXPECT_EQ(rig.node.counters().watchdog, 1u);
  rig.sent = 0;  // two commands without enable, then with it
  for (int i = 0; i < 6; ++i) sample = rig.tick({1, 0, 0});
  EXPECT_EQ(rig.node.plant().motor().force_N.x, 1.0);
  EXPECT_EQ(sample.flags & (DeviceFlag::kWatchdog | DeviceFlag::kEnabled), DeviceFlag::kEnabled);
}

// A node that has just got power renders nothing for a controller that has been enabling all along.
TEST(Node, AfterPowerUpNeedsAnEnableEdge) {
  Rig rig;
  rig.sent = 2;
  DeviceSample sample;
  for (int i = 0; i < 10; ++i) sample = rig.tick({1, 0, 0});
  EXPECT_EQ(rig.node.plant().motor().force_N, Vec3{});
  EXPECT_EQ(sample.flags & DeviceFlag::kWatchdog, DeviceFlag::kWatchdog);
  rig.node.set_powered(false);
  rig.tick();
  rig.node.set_powered(true);
  for (int i = 0; i < 10; ++i) rig.tick({1, 0, 0});
  EXPECT_EQ(rig.node.plant().motor().force_N, Vec3{});
}

// Lost and late commands, the watchdog: the hand gets a slope of a tenth of the motors' limit a millisecond, no step.
TEST(Node, ChangesItsForceNoFasterThanItsSlewLimit) {
  Rig rig(WireProfile::kFd, {{40, 10, TransportFault::kLoseSent}, {60, 40, TransportFault::kLoseSent}});
  double last_N = 0, largest_N = 0, top_N = 0;
  for (int i = 0; i < 120; ++i) {
    rig.tick({i < 45 ? 8.0 : -8.0, 0, 0});
    const double now_N = rig.node.plant().motor().force_N.x;
    largest_N = max_of(largest_N, abs_of(now_N - last_N));
    top_N = max_of(top_N, now_N);
    last_N = now_N;
  }
  EXPECT_NEAR(top_N, 8, 1e-9);
  EXPECT_NEAR(largest_N, 0.85, 1e-9);
  EXPECT_EQ(last_N, 0) << "the watchdog tripped and nothing enabled it anew";
}

TEST(Node, EmergencyStopAndErrorCutTheForceAndReachTheController) {
  Rig rig;
  for (int i = 0; i < 5; ++i) rig.tick({1, 0, 0});
  rig.node.press_stop(true);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rig.tick({1, 0, 0}).faults, Fault::kDeviceReported);
  EXPECT_EQ(rig.node.plant().motor().force_N, Vec3{});
  rig.node.press_stop(false);
  EXPECT_EQ(rig.tick().faults, 0u);
  rig.node.set_error(42);
  EXPECT_EQ(rig.tick().error_code, 42u);
}

TEST(Node, AnswersNoForeignOrRandomFrames) {
  Rig rig;
  std::uint32_t seed = 1;
  for (int i = 0; i < 500; ++i) {
    Frame junk;
    junk.id = 0x100 + (seed = seed * 1664525u + 1013904223u) % 0x100;
    junk.fd = (seed >> 20) % 2 == 0;
    junk.length = static_cast<std::uint8_t>((seed >> 24) % 9);
    for (std::uint8_t& byte : junk.data) byte = static_cast<std::uint8_t>(seed = seed * 1664525u + 1013904223u);
    rig.pair.first->send({&junk, 1});
    rig.node.step(rig.now_ns += kPeriod_ns);
  }
  EXPECT_EQ(rig.node.counters().commands, 0u);
  EXPECT_EQ(rig.node.counters().bad, 500u);
}

TEST(DeviceBus, ARestartedDeviceIsNoticed) {
  SequenceTracker sequence(16);
  std::uint32_t missing = 0;
  EXPECT_EQ(sequence.follow(40'000, missing), SequenceTracker::Step::kNew);
  EXPECT_EQ(sequence.follow(40'003, missing), SequenceTracker::Step::kNew);
  EXPECT_EQ(missing, 2u);
  EXPECT_EQ(sequence.follow(40'001, missing), SequenceTracker::Step::kReordered);
  EXPECT_EQ(sequence.follow(20'000, missing), SequenceTracker::Step::kRestart);
  EXPECT_EQ(missing, 0u);
  EXPECT_EQ(sequence.follow(20'001, missing), SequenceTracker::Step::kNew);
}

TEST(DeviceBus, AnotherProtocolVersionIsRefused) {
  std::string error;
  auto [host, device] = open_loopback_pair(error);
  DeviceBus bus(*host, WireProfile::kFd);
  wire::Status status;
  status.version = 1;
  Frame frames[2];
  make_status_frames(1, status, frames);
  device->send({frames, 1});
  DeviceSample sample;
  bus.receive(sample);
  EXPECT_FALSE(sample.fresh);
  EXPECT_EQ(bus.counters().version, 1u);
}

// A reference lost in motion: positions no longer mean a place. Planted once as no fault at all.
TEST(DeviceBus, ALostCalibrationIsAFaultOfItsOwn) {
  std::string error;
  auto [host, device] = open_loopback_pair(error);
  DeviceBus bus(*host, WireProfile::kFd);
  DeviceSample sample;
  bus.receive(sample);
  EXPECT_EQ(sample.faults, 0u) << "nothing came yet, so nothing is missing";
  for (const std::uint32_t flags : {DeviceFlag::kCalibrated, 0u, DeviceFlag::kError, DeviceFlag::kCalibrated}) {
    wire::Status status;
    status.sequence = bus.newest().sequence + 1;
    status.flags = flags;
    Frame frames[2];
    make_status_frames(1, status, frames);
    device->send({frames, 1});
    bus.receive(sample);
    ASSERT_TRUE(sample.fresh);
    const std::uint32_t lost = flags == DeviceFlag::kCalibrated ? 0u : Fault::kNotCalibrated;
    EXPECT_EQ(sample.faults, lost | (flags == DeviceFlag::kError ? Fault::kDeviceReported : 0u)) << flags;
  }
}

// Each way a frame can be useless is counted by itself, and the first one is kept for the person who must mend it.
TEST(DeviceBus, EveryUselessFrameIsCountedByItsCause) {
  std::string error;
  auto [host, device] = open_loopback_pair(error);
  DeviceBus bus(*host, WireProfile::kFd);
  wire::Status status;
  status.quaternion[0] = 16384;  // |q|^2 = 0.25
  Frame good[2], frame;
  make_status_frames(1, status, good);
  const auto send = [&](Frame bad) {
    device->send({&bad, 1});
    DeviceSample sample;
    bus.receive(sample);
    return sample.fresh;
  };
  frame = good[0];
  frame.data[5] ^= 1;
  EXPECT_FALSE(send(frame));
  frame = good[0];
  frame.id += 1;
  EXPECT_FALSE(send(frame));
  frame = good[0];
  frame.length = 24;
  EXPECT_FALSE(send(frame));
  frame = good[0];
  frame.fd = false;
  frame.length = 8;
  EXPECT_FALSE(send(frame));
  EXPECT_TRUE(send(good[0]));
  const BusCounters& c = bus.counters();
  EXPECT_EQ(c.frames, 5u);
  EXPECT_EQ(c.checksum, 1u);
  EXPECT_EQ(c.identifier, 1u);
  EXPECT_EQ(c.length, 1u);
  EXPECT_EQ(c.kind, 1u);
  EXPECT_EQ(c.orientation, 1u);
  EXPECT_EQ(c.accepted, 1u);
  EXPECT_EQ(bus.first_reason(), DropReason::kChecksum);
  EXPECT_EQ(bus.first_bad().id, 0x181u);
  EXPECT_EQ(bus.first_bad().data[5], good[0].data[5] ^ 1);
}

// Extended and remote frames carry other identifiers with the same low bits; they are nobody's samples.
TEST(Loopback, ExtendedAndRemoteFramesAreCountedNotUsed) {
  int fd[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, fd), 0);
  std::string error;
  const auto transport = adopt_loopback(fd[0], error);
  ASSERT_NE(transport, nullptr) << error;
  for (const std::uint32_t flag : {0u, CAN_EFF_FLAG, CAN_RTR_FLAG}) {
    canfd_frame raw{};
    raw.can_id = 0x181u | flag;
    raw.len = 8;
    EXPECT_EQ(::send(fd[1], &raw, CAN_MTU, 0), static_cast<ssize_t>(CAN_MTU));
    EXPECT_EQ(::send(fd[1], &raw, CANFD_MTU, 0), static_cast<ssize_t>(CANFD_MTU));
  }
  Frame frames[8];
  EXPECT_EQ(transport->receive(frames), 2);
  EXPECT_EQ(transport->counters().malformed, 4u);
  EXPECT_EQ(transport->state(), TransportState::kUp);
  ::close(fd[1]);
}

// For who asks: identifiers of 29 bits there and back, bit by bit as linux/can.h has them; short ones stay short.
TEST(Loopback, ExtendedFramesAreHandedOutToWhoAsks) {
  int fd[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, fd), 0);
  std::string error;
  const auto transport = adopt_loopback(fd[0], error);
  ASSERT_NE(transport, nullptr) << error;
  transport->accept_extended();
  for (const std::uint32_t id : {0x7FFu, 0x800u, 0x8001u, 0x1FFFFFFFu}) {
    const Frame out{.id = id, .length = 8, .fd = true};
    ASSERT_EQ(transport->send({&out, 1}), 1);
    canfd_frame raw{};
    ASSERT_EQ(::recv(fd[1], &raw, sizeof raw, 0), static_cast<ssize_t>(CANFD_MTU));
    EXPECT_EQ(raw.can_id, id > 0x7FF ? id | CAN_EFF_FLAG : id);
    ASSERT_EQ(::send(fd[1], &raw, CANFD_MTU, 0), static_cast<ssize_t>(CANFD_MTU));
    Frame in[2];
    ASSERT_EQ(transport->receive(in), 1);
    EXPECT_EQ(in[0].id, id);
  }
  ::close(fd[1]);
}

TEST(Loopback, ForeignDatagramsAreCountedNotUsed) {
  int fd[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, fd), 0);
  std::string error;
  const auto transport = adopt_loopback(fd[0], error);
  ASSERT_NE(transport, nullptr) << error;
  EXPECT_EQ(::send(fd[1], "hello", 5, 0), 5);
  Frame frames[4];
  EXPECT_EQ(transport->receive(frames), 0);
  EXPECT_EQ(transport->counters().malformed, 1u);
  EXPECT_EQ(transport->state(), TransportState::kUp);
  ::close(fd[1]);
  EXPECT_EQ(transport->receive(frames), 0);
  EXPECT_EQ(transport->state(), TransportState::kDown);
  EXPECT_EQ(transport->send({frames, 1}), 0);  // and no SIGPIPE
  EXPECT_EQ(transport->counters().send_dropped, 1u);
}

TEST(Loopback, ConnectsByAbstractNameAndByPath) {
  const std::string unique = "palpate-test-" + std::to_string(::getpid());
  for (const std::string& name : {unique, "/tmp/" + unique}) {
    std::string connect_error, accept_error;
    std::unique_ptr<Transport> device;
    std::thread other([&] { device = connect_loopback(name, 10'000, connect_error); });
    const auto host = accept_loopback(name, 10'000, accept_error);
    other.join();
    ASSERT_NE(host, nullptr) << accept_error;
    ASSERT_NE(device, nullptr) << connect_error;
    Frame frame;
    frame.id = 0x123;
    frame.length = 3;
    EXPECT_EQ(device->send({&frame, 1}), 1);
    Frame got[4];
    EXPECT_EQ(host->receive(got), 1);
    EXPECT_EQ(got[0].id, 0x123u);
    EXPECT_FALSE(got[0].fd);
    EXPECT_NE(::access(("/tmp/" + unique).c_str(), F_OK), 0);  // the path does not stay behind
  }
}

TEST(Loopback, NobodyThereIsAClearError) {
  std::string error;
  EXPECT_EQ(accept_loopback("palpate-test-nobody", 10, error), nullptr);
  EXPECT_NE(error.find("nobody connected"), std::string::npos) << error;
  EXPECT_EQ(connect_loopback("palpate-test-nobody", 10, error), nullptr);
  EXPECT_NE(error.find("palpate-test-nobody"), std::string::npos) << error;
  EXPECT_EQ(connect_loopback(std::string(200, 'x'), 10, error), nullptr);
  EXPECT_NE(error.find("characters"), std::string::npos) << error;
  EXPECT_EQ(adopt_loopback(-1, error), nullptr);
}

TEST(SocketCan, UnknownAndWrongInterfacesAreClearErrors) {
  const std::uint32_t ids[] = {0x181};
  std::string error;
  EXPECT_EQ(open_socketcan({"palpatex0", true, ids}, error), nullptr);
  EXPECT_NE(error.find("no network interface 'palpatex0'"), std::string::npos) << error;
  EXPECT_EQ(open_socketcan({"lo", true, ids}, error), nullptr);
  EXPECT_NE(error.find("lo' is not a CAN interface"), std::string::npos) << error;
  EXPECT_EQ(open_socketcan({"a-name-that-is-too-long", true, ids}, error), nullptr);
  EXPECT_NE(error.find("not an interface name"), std::string::npos) << error;
}

TEST(DeviceAddress, ReadsWhatTheHelpSays) {
  std::string line, error;
  const auto can = parse_device_address("can:can0,classic,node=3", line, error);
  ASSERT_TRUE(can.has_value()) << error;
  EXPECT_EQ(can->kind, TransportKind::kCan);
  EXPECT_EQ(can->name, "can0");
  EXPECT_EQ(can->profile, WireProfile::kClassic);
  EXPECT_EQ(can->node, 3);
  const auto loop = parse_device_address("loopback:/tmp/x", line, error);
  ASSERT_TRUE(loop.has_value());
  EXPECT_EQ(loop->name, "/tmp/x");
  const auto chosen = parse_device_address("auto", line, error);
  ASSERT_TRUE(chosen.has_value());
  EXPECT_EQ(chosen->kind, find_can_interface().empty() ? TransportKind::kLoopback : TransportKind::kCan);
  EXPECT_EQ(line.rfind("device: ", 0), 0u);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  for (const char* bad : {"", "can:", "can", "usb", "loopback:", "can:x,node=0", "can:x,node=16", "can:x,node=1x",
                          "loopback,fast", "can:x,"}) {
    EXPECT_FALSE(parse_device_address(bad, line, error).has_value()) << bad;
    EXPECT_EQ(error.rfind("device: ", 0), 0u);
  }
  EXPECT_EQ(open_transport({TransportKind::kCan, "palpatex0"}, DeviceSide::kController, 1, error), nullptr);
  EXPECT_NE(error.find("palpatex0"), std::string::npos);
}

}  // namespace
}  // namespace palpate
