// Serialisation delay: frames leave when their last bit would have, one behind the other.
#include <gtest/gtest.h>

#include "hal/bus/bus_model.h"

namespace palpate {
namespace {

struct Sink : Transport {
  int send(std::span<const Frame> frames) noexcept override {
    sent += static_cast<int>(frames.size());
    return static_cast<int>(frames.size());
  }
  int receive(std::span<Frame>) noexcept override { return 0; }
  TransportState state() const noexcept override { return TransportState::kUp; }
  const TransportCounters& counters() const noexcept override { return none; }
  int sent = 0;
  TransportCounters none;
};

Frame frame(int bytes, bool fd) {
  Frame f;
  f.id = 0x181;
  f.length = static_cast<std::uint8_t>(bytes);
  f.fd = fd;
  return f;
}

TEST(BusModel, FrameTimesAreThoseOfTheBudget) {
  EXPECT_EQ(frame_time_ns(frame(8, false), {}), 135'000);  // 135 bits at 1 Mbit/s
  EXPECT_EQ(frame_time_ns(frame(0, false), {}), 55'000);
  EXPECT_EQ(frame_time_ns(frame(32, true), {}), 34'000 + 358 * 200);  // 34 nominal bits, 38 + 320 at 5 Mbit/s
  EXPECT_EQ(frame_time_ns(frame(8, false), {500e3, 5e6}), 270'000);
}

TEST(BusModel, FramesQueueBehindOneAnother) {
  Sink sink;
  BusModel bus(sink, {});
  EXPECT_EQ(bus.next_ns(), -1);
  bus.advance(1'000'000);
  const Frame two[2] = {frame(8, false), frame(8, false)};
  EXPECT_EQ(bus.send(two), 2);
  EXPECT_EQ(bus.next_ns(), 1'135'000);
  bus.advance(1'134'999);
  EXPECT_EQ(sink.sent, 0);
  bus.advance(1'135'000);
  EXPECT_EQ(sink.sent, 1);
  EXPECT_EQ(bus.next_ns(), 1'270'000);
  bus.advance(5'000'000);
  EXPECT_EQ(sink.sent, 2);
  bus.send(two);  // an idle bus starts anew
  EXPECT_EQ(bus.next_ns(), 5'135'000);
}

TEST(BusModel, AFullQueueDropsTheRest) {
  Sink sink;
  BusModel bus(sink, {});
  for (int i = 0; i < kMaxFramesPerReceive; ++i) {
    const Frame one = frame(8, false);
    EXPECT_EQ(bus.send({&one, 1}), 1);
  }
  const Frame last = frame(8, false);
  EXPECT_EQ(bus.send({&last, 1}), 0);
  bus.advance(1'000'000'000);
  EXPECT_EQ(sink.sent, kMaxFramesPerReceive);
}

}  // namespace
}  // namespace palpate
