// Reports written by a thread of their own: handed over at once, the newest wins, errors come back.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "hal/bus/usb_hid.h"
#include "hal/loop/report_writer.h"

namespace palpate {
namespace {

// A socket pair whose far end takes nothing until it is read: like a device that has not been polled.
struct Wire {
  Wire() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, end), 0); }
  ~Wire() {
    ::close(end[0]);
    if (end[1] >= 0) ::close(end[1]);
  }
  std::uint8_t read_first() {
    std::uint8_t report[ReportWriter::kBytes] = {};
    EXPECT_EQ(::read(end[1], report, sizeof report), static_cast<ssize_t>(sizeof report));
    return report[1];
  }
  int end[2];
};

TEST(ReportWriter, WritesWhatItIsGivenInOrder) {
  Wire wire;
  ReportWriter writer(wire.end[0]);
  for (std::uint8_t n = 1; n <= 50; ++n) {
    ReportWriter::Report reports[2] = {{0, n}, {0, static_cast<std::uint8_t>(n + 100)}};
    EXPECT_TRUE(writer.put(reports, 2));
    EXPECT_EQ(wire.read_first(), n);
    EXPECT_EQ(wire.read_first(), n + 100);
  }
  EXPECT_EQ(writer.take_error(), 0);
}

// A device that takes nothing: put() still returns at once, and what waits is always the newest command.
TEST(ReportWriter, NeverWaitsAndKeepsOnlyTheNewest) {
  Wire wire;
  ReportWriter writer(wire.end[0]);
  constexpr int kCommands = 5000;  // far beyond what the socket holds
  int replaced = 0;
  for (int n = 0; n < kCommands; ++n) {
    const ReportWriter::Report report[1] = {{0, static_cast<std::uint8_t>(n % 251)}};
    replaced += writer.put(report, 1) ? 0 : 1;
  }
  EXPECT_GT(replaced, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const int flags = ::fcntl(wire.end[1], F_GETFL);
  std::uint8_t last = 255;
  for (int quiet = 0; quiet < 20;) {  // until nothing has come for 20 ms
    std::uint8_t report[ReportWriter::kBytes];
    ::fcntl(wire.end[1], F_SETFL, flags | O_NONBLOCK);
    if (::read(wire.end[1], report, sizeof report) > 0) {
      last = report[1];
      quiet = 0;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ++quiet;
    }
  }
  EXPECT_EQ(last, (kCommands - 1) % 251);
}

TEST(ReportWriter, AnErrorComesBackThroughTheTransport) {
  ::signal(SIGPIPE, SIG_IGN);
  Wire wire;
  UsbHid hid(::dup(wire.end[0]), UsbSide::kController);
  hid.write_in_background();
  ::close(wire.end[1]);
  wire.end[1] = -1;
  Frame frame;
  frame.id = 0x101;
  frame.length = 20;
  for (int i = 0; i < 1000 && hid.state() == TransportState::kUp; ++i) {
    hid.send({&frame, 1});
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(hid.state(), TransportState::kDown);
  EXPECT_EQ(hid.send({&frame, 1}), 0);
}

}  // namespace
}  // namespace palpate
