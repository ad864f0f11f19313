// The slots follow a device with a clock of its own: no sample is missed or doubled once they do, whichever way and
// however far the clocks differ, and no slot is ever longer or shorter than it may be.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <thread>

#include "hal/bus/device_bus.h"
#include "hal/bus/loopback.h"
#include "hal/loop/loop.h"

namespace palpate {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

// Samples at the ticks of its own clock, each up to `jitter_ns` late on the bus. It sees no loop and obeys nothing.
class ClockedDevice {
 public:
  ClockedDevice(const VirtualClock& clock, double ppm, double first_ns, double jitter_ns)
      : clock_(clock), period_ns_(1e6 / (1 + 1e-6 * ppm)), next_ns_(first_ns), jitter_ns_(jitter_ns) {}
  void receive(DeviceSample& sample) noexcept {
    sample.received = 0;
    for (double at_ns = arrival_ns(); at_ns <= static_cast<double>(clock_.now_ns()); at_ns = arrival_ns()) {
      sample.received += 1;
      sample.age_ns = tells_age ? clock_.now_ns() - static_cast<std::int64_t>(at_ns) : -1;
      next_ns_ += period_ns_;
      late_ns_ = jitter_ns_ * std::uniform_real_distribution<>(0, 1)(draw_);
    }
    sample.fresh = sample.received > 0;
    sample.flags = DeviceFlag::kCalibrated;
    ticks += 1;
    if (ticks <= settle_ticks) return;
    held += sample.received == 0;
    doubled += sample.received > 1;
  }
  bool transmit(const DeviceCommand&) noexcept { return true; }

  bool tells_age = true;
  int ticks = 0, settle_ticks = 0, held = 0, doubled = 0;

 private:
  double arrival_ns() const { return next_ns_ + late_ns_; }
  const VirtualClock& clock_;
  double period_ns_, next_ns_, jitter_ns_, late_ns_ = 0;
  std::mt19937 draw_{5};
};

struct Nothing {
  void step(const Input&, Output& output, const StageProbe&) { output = {}; }
  void fill(const Input&, const Output&, TickRecord&) {}
};
struct Slots {
  std::vector<std::int64_t> deadline_ns;
  void publish(const TickRecord& record) { deadline_ns.push_back(record.timing.deadline_ns); }
};
struct Nobody {
  std::uint32_t poll() { return 0; }
};

struct Ran {
  LoopSummary summary;
  Slots slots;
};
Ran run_with(ClockedDevice& device, VirtualClock& clock, std::uint64_t ticks) {
  Ran run;
  Nothing nothing;
  Nobody nobody;
  LoopOptions options;
  options.ticks = ticks;
  const std::atomic<bool> stop{false};
  run.summary = Loop(device, clock, nothing, run.slots, nobody, CartesianKinematics{}, options, stop).run();
  return run;
}

// 50 us of jitter is what a bus with other traffic gives a frame that waits for one of the longest classic ones twice.
constexpr double kJitter_ns = 50e3;
constexpr int kSettle_ticks = 2000;  // 16 time constants, and the 50 ms of a way of half a period at 1 %

TEST(PhaseLock, NoSampleIsMissedOnceItHolds) {
  for (const double ppm : {-4000.0, -300.0, -20.0, 0.0, 20.0, 300.0, 4000.0})
    for (const double phase_ns : {0.0, 0.25e6, 0.5e6, 0.99e6}) {
      VirtualClock clock;
      ClockedDevice device(clock, ppm, phase_ns, kJitter_ns);
      device.settle_ticks = kSettle_ticks;
      const Ran run = run_with(device, clock, 20'000);
      EXPECT_EQ(device.held, 0) << ppm << " ppm, from " << phase_ns;
      EXPECT_EQ(device.doubled, 0) << ppm << " ppm, from " << phase_ns;
      EXPECT_TRUE(run.summary.phase_locked);
      // Jitter of 14.4 us rms through the integrator, whose answer to one sample is k_i (1 - n/128) exp(-n/128): the
      // squares add up to 32 k_i^2, which makes 5 ns a slot, 5 ppm. Four times that.
      EXPECT_NEAR(run.summary.device_ppm, ppm, 20);
      EXPECT_LT(run.summary.worst_phase_ns, kPeriod_ns / 8 + 60'000) << ppm << " ppm, from " << phase_ns;
    }
}

// The same device and a bus that tells no arrival: the beat of the clocks is back. At 300 ppm it lasts 3.3 s, and
// within the 50 us of jitter (167 ticks of each) samples miss and double.
TEST(PhaseLock, WithoutItTheClocksBeat) {
  VirtualClock clock;
  ClockedDevice device(clock, 300, 0, kJitter_ns);
  device.settle_ticks = kSettle_ticks;
  device.tells_age = false;
  const Ran run = run_with(device, clock, 20'000);
  EXPECT_GT(device.doubled, 5);
  EXPECT_GT(device.held, 0);
  EXPECT_FALSE(run.summary.phase_locked);
  for (std::size_t i = 1; i < run.slots.deadline_ns.size(); ++i)
    ASSERT_EQ(run.slots.deadline_ns[i] - run.slots.deadline_ns[i - 1], kPeriod_ns);  // the grid, to the nanosecond
}

// 2 % is more than it may follow: slots stay within 1 % of the period, and the loop renders on.
TEST(PhaseLock, NoSlotIsMoreThanAHundredthOff) {
  for (const double ppm : {-20'000.0, 20'000.0, 5'000.0}) {
    VirtualClock clock;
    ClockedDevice device(clock, ppm, 0, 0.4e6);
    const Ran run = run_with(device, clock, 5000);
    EXPECT_EQ(run.summary.missed_slots, 0u);
    for (std::size_t i = 1; i < run.slots.deadline_ns.size(); ++i) {
      const std::int64_t step_ns = run.slots.deadline_ns[i] - run.slots.deadline_ns[i - 1];
      ASSERT_LE(std::llabs(step_ns - kPeriod_ns), kPeriod_ns / PhaseLock::kMostShare) << ppm;
    }
  }
}

TEST(PhaseLock, SilenceKeepsTheDifferenceOfTheClocks) {
  PhaseLock lock(kPeriod_ns);
  double age_ns = 0.5e6;
  for (int i = 0; i < 5000; ++i) {  // the device is 100 ppm fast: each sample is 100 ns older than the one before
    lock.see(static_cast<std::int64_t>(age_ns));
    age_ns += 100.0 + static_cast<double>(lock.correction_ns());
  }
  EXPECT_NEAR(lock.device_ppm(), 100, 2);  // whole nanoseconds: errors below 64 are not acted upon at once
  std::int64_t moved_ns = 0;
  for (int i = 0; i < 1000; ++i) moved_ns += lock.correction_ns();  // a second without a sample
  EXPECT_NEAR(static_cast<double>(moved_ns), -100e3, 2e3);
}

// An age that no frame can have, however it came about, moves a slot by a hundredth and no more.
TEST(PhaseLock, HostileAgesAreBounded) {
  PhaseLock lock(kPeriod_ns);
  std::mt19937_64 draw(3);
  for (int i = 0; i < 100'000; ++i) {
    const std::int64_t far_ns = 4'000'000'000'000'000'000;
    lock.see(static_cast<std::int64_t>(draw() >> 1) % far_ns * (i % 2 == 0 ? 1 : -1));
    ASSERT_LE(std::llabs(lock.correction_ns()), kPeriod_ns / PhaseLock::kMostShare);
  }
  EXPECT_LE(std::abs(lock.device_ppm()), 1e6 / PhaseLock::kMostShare);
}

// The kernel's stamp of a frame, bounded by clock readings around sending and receiving.
TEST(ArrivalStamps, TellHowLongAFrameWaited) {
  std::string error;
  auto [near, far] = open_loopback_pair(error);
  ASSERT_TRUE(near) << error;
  const MonotonicClock clock;
  Frame frame{.id = 1, .length = 8}, received[2];
  ASSERT_EQ(far->send({&frame, 1}), 1);
  ASSERT_EQ(near->receive(received), 1);
  EXPECT_LT(received[0].age_ns, 0);  // nobody asked
  near->stamp_arrivals();
  const std::int64_t before_ns = clock.now_ns();
  ASSERT_EQ(far->send({&frame, 1}), 1);
  const std::int64_t sent_ns = clock.now_ns();
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const std::int64_t asked_ns = clock.now_ns();
  ASSERT_EQ(near->receive(received), 1);
  const std::int64_t done_ns = clock.now_ns();
  constexpr std::int64_t kSlewed_ns = 100'000;  // the stamps' clock may be steered meanwhile (500 ppm at most)
  EXPECT_GE(received[0].age_ns, asked_ns - sent_ns - kSlewed_ns);
  EXPECT_LE(received[0].age_ns, done_ns - before_ns + kSlewed_ns);
}

}  // namespace
}  // namespace palpate
