// The USB transport's report format and its bookkeeping, over a socket pair that keeps record boundaries as hidraw
// does.
#include "hal/bus/usb_hid.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

namespace palpate::test {
namespace {

struct Pipe {
  int raw[2];
  Pipe() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, raw), 0); }
};

Frame frame_of(std::uint32_t id, std::uint8_t length) {
  Frame frame;
  frame.id = id;
  frame.length = length;
  for (std::uint8_t i = 0; i < length; ++i) frame.data[i] = static_cast<std::uint8_t>(i * 7 + 1);
  return frame;
}

TEST(UsbHid, DeviceReportsReachTheController) {
  Pipe pipe;
  UsbHid device(pipe.raw[0], UsbSide::kDevice), controller(pipe.raw[1], UsbSide::kController);
  const Frame sent[2] = {frame_of(0x181, 32), frame_of(0x7FF, 8)};
  EXPECT_EQ(device.send(sent), 2);
  Frame got[8];
  ASSERT_EQ(controller.receive(got), 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(got[i].id, sent[i].id);
    EXPECT_EQ(got[i].length, sent[i].length);
    EXPECT_EQ(std::memcmp(got[i].data, sent[i].data, sent[i].length), 0);
  }
  EXPECT_EQ(controller.receive(got), 0) << "drained: nothing, without waiting";
  EXPECT_EQ(controller.state(), TransportState::kUp);
}

TEST(UsbHid, ControllerReportsStartWithTheirNumber) {
  Pipe pipe;
  UsbHid controller(pipe.raw[1], UsbSide::kController);
  const Frame sent[1] = {frame_of(0x101, 16)};
  EXPECT_EQ(controller.send(sent), 1);
  std::uint8_t report[100];
  ASSERT_EQ(read(pipe.raw[0], report, sizeof report), 65);
  EXPECT_EQ(report[0], 0);
  EXPECT_EQ(report[1], 16);
  EXPECT_EQ(report[2], 0x01);
  EXPECT_EQ(report[3], 0x01);
  EXPECT_EQ(report[4], 1);
  close(pipe.raw[0]);
}

TEST(UsbHid, MalformedReportsAreCountedAndDropped) {
  Pipe pipe;
  UsbHid controller(pipe.raw[1], UsbSide::kController);
  std::uint8_t report[kReportBytes] = {62};  // a length that does not fit
  EXPECT_EQ(write(pipe.raw[0], report, sizeof report), kReportBytes);
  EXPECT_EQ(write(pipe.raw[0], report, 10), 10);  // a short report
  Frame got[4];
  EXPECT_EQ(controller.receive(got), 0);
  EXPECT_EQ(controller.counters().malformed, 2u);
  close(pipe.raw[0]);
}

TEST(UsbHid, AFullQueueIsReportedAsOverflow) {
  Pipe pipe;
  UsbHid device(pipe.raw[0], UsbSide::kDevice), controller(pipe.raw[1], UsbSide::kController);
  const Frame sent[1] = {frame_of(0x181, 32)};
  for (int i = 0; i < kHidrawQueue; ++i) ASSERT_EQ(device.send(sent), 1);
  Frame got[kMaxFramesPerReceive];
  EXPECT_EQ(controller.receive(got), kHidrawQueue);
  EXPECT_EQ(controller.counters().overflow, 1u);
}

// The two halves of a command belong together: after the first was refused the second stays here too. A pending error
// of a socket makes exactly one write fail.
TEST(UsbHid, TheSecondHalfIsNotSentWhenTheFirstFailed) {
  const int sender = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0), probe = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  ASSERT_EQ(bind(probe, reinterpret_cast<sockaddr*>(&at), size), 0);
  ASSERT_EQ(getsockname(probe, reinterpret_cast<sockaddr*>(&at), &size), 0);
  close(probe);  // nobody listens at this port for a moment
  ASSERT_EQ(connect(sender, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  ASSERT_EQ(write(sender, "x", 1), 1);  // answered by "refused", which the next write reports
  const int listener = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  UsbHid controller(sender, UsbSide::kController);
  const Frame halves[2] = {frame_of(0x101, 16), frame_of(0x102, 16)};
  EXPECT_EQ(controller.send(halves), 0);
  EXPECT_EQ(controller.counters().send_dropped, 2u);
  std::uint8_t report[100];
  EXPECT_EQ(read(listener, report, sizeof report), -1) << "a half command went out";
  close(listener);
}

TEST(UsbHid, UnpluggingIsNoticedOnBothSides) {
  Pipe pipe;
  UsbHid controller(pipe.raw[1], UsbSide::kController);
  close(pipe.raw[0]);
  Frame got[4];
  EXPECT_EQ(controller.receive(got), 0);
  EXPECT_EQ(controller.state(), TransportState::kDown);
}

TEST(UsbHid, WrongPathsAreExplained) {
  std::string error;
  EXPECT_EQ(open_usb_hid("/dev/hidraw-none", UsbSide::kController, error), nullptr);
  EXPECT_NE(error.find("plugged in"), std::string::npos) << error;
  EXPECT_EQ(open_usb_hid("/dev/null", UsbSide::kController, error), nullptr);
  EXPECT_NE(error.find("not a HID device"), std::string::npos) << error;
}

}  // namespace
}  // namespace palpate::test
