// Fuzzer of everything that reads frames: codec, device bus in both profiles, the device's node, the report. The input
// is a list of frames: identifier (2 bytes), kind and length (1 byte: bit 7 FD), data. Frames whose first length bit
// pattern asks for it get the right checksum, so that the fuzzer reaches what lies behind it.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "hal/bus/link_report.h"
#include "hal/device/device_node.h"
#include "hal/loop/link_watch.h"

namespace palpate {
namespace {

// Hands out what it is given, at most kMaxFramesPerReceive at a time; remembers what was sent.
class MemoryTransport : public Transport {
 public:
  std::vector<Frame> waiting;
  std::vector<Frame> sent;
  int send(std::span<const Frame> frames) noexcept override {
    sent.assign(frames.begin(), frames.end());
    return static_cast<int>(frames.size());
  }
  int receive(std::span<Frame> frames) noexcept override {
    std::size_t count = 0;
    for (; count < frames.size() && count < waiting.size(); ++count) frames[count] = waiting[count];
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(count));
    return static_cast<int>(count);
  }
  TransportState state() const noexcept override { return TransportState::kUp; }
  const TransportCounters& counters() const noexcept override { return counters_; }

 private:
  TransportCounters counters_;
};

void require(bool holds) {
  if (!holds) std::abort();
}

// Makes the checksum right: wide for FD, narrow otherwise.
void seal(Frame& frame) {
  const std::size_t bytes = frame.fd ? 2 : 1;
  if (frame.length < bytes) return;
  const std::uint8_t head[2] = {static_cast<std::uint8_t>(frame.id & 0xFF), static_cast<std::uint8_t>(frame.id >> 8)};
  const std::size_t covered = frame.length - bytes;
  if (frame.fd) {
    const std::uint16_t crc = wire::crc16({frame.data, covered}, wire::crc16(head));
    frame.data[covered] = static_cast<std::uint8_t>(crc & 0xFF);
    frame.data[covered + 1] = static_cast<std::uint8_t>(crc >> 8);
  } else {
    frame.data[covered] = wire::crc8({frame.data, covered}, static_cast<std::uint8_t>(wire::crc8(head) ^ 0xFF));
  }
}

std::vector<Frame> frames_of(std::span<const std::uint8_t> input) {
  std::vector<Frame> frames;
  while (input.size() >= 4) {
    Frame frame;
    frame.id = (input[0] | static_cast<std::uint32_t>(input[1]) << 8) & 0x7FFu;
    frame.fd = (input[2] & 0x80) != 0;
    frame.length = static_cast<std::uint8_t>(input[2] & 0x7F);
    if (frame.length > 64) frame.length = 64;
    const bool sealed = (input[3] & 1) != 0;
    input = input.subspan(4);
    const std::size_t given = frame.length < input.size() ? frame.length : input.size();
    std::memcpy(frame.data, input.data(), given);
    input = input.subspan(given);
    if (sealed) seal(frame);
    frames.push_back(frame);
  }
  return frames;
}

bool sane(const DeviceSample& sample) {
  return is_finite(sample.position_m) && is_finite(sample.orientation.w) && is_finite(sample.orientation.x) &&
         is_finite(sample.orientation.y) && is_finite(sample.orientation.z) && norm(sample.position_m) < 2;
}

void feed_bus(const std::vector<Frame>& frames, WireProfile profile) {
  MemoryTransport transport;
  DeviceBus bus(transport, profile);
  LinkWatch link{LinkLimits{}};
  DeviceSample sample;
  for (std::size_t i = 0; i < frames.size(); i += 3) {
    transport.waiting.assign(
        frames.begin() + static_cast<std::ptrdiff_t>(i),
        frames.begin() + static_cast<std::ptrdiff_t>(i + 3 < frames.size() ? i + 3 : frames.size()));
    bus.receive(sample);
    require(sane(sample));
    link.look(sample);
    bus.transmit({{1, 2, 3}, {}, link.enable(true, i % 2 == 0) ? CommandFlag::kEnable : 0u});
  }
  require(bus.counters().frames == frames.size());
  const LinkReport report = report_link(bus, transport.state());
  require(report.good || !report.remedy.empty());
}

void feed_node(const std::vector<Frame>& frames, WireProfile profile) {
  MemoryTransport transport;
  NodeOptions options;
  options.profile = profile;
  PlantOptions plant;
  plant.substeps = 1;
  DeviceNode node(transport, options, plant, {});
  Vec3 last_N;
  std::int64_t now_ns = 0;
  for (const Frame& frame : frames) {
    transport.waiting.push_back(frame);
    node.step(now_ns += 1'000'000);
    const Vec3 force_N = node.plant().motor().force_N;
    require(is_finite(force_N) && norm(force_N) <= plant.force_max_N * (1 + 1e-9));
    require(norm(force_N - last_N) <= 0.1 * plant.force_max_N * (1 + 1e-9));
    last_N = force_N;
  }
}

}  // namespace
}  // namespace palpate

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  const std::vector<Frame> frames = frames_of({data, size});
  for (const WireProfile profile : {WireProfile::kFd, WireProfile::kClassic}) {
    feed_bus(frames, profile);
    feed_node(frames, profile);
  }
  return 0;
}
