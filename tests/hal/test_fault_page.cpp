// docs/faults.md to a tick: what its table says of a fault, read from the page itself, against what the fault does in
// virtual time. The tests beside this one say what else holds; their bounds may be wider.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "tests/hal/evil_device.h"
#include "tests/hal/fault_judge.h"

namespace palpate {
namespace {

using test::at_fault;
using test::Attack;
using test::Attacker;
using test::EvilDevice;
using test::FaultRun;
using test::kTick;
using test::Meddle;
using test::run_with_faults;
using test::Surroundings;

// Cells of the row of the page's first table whose cause contains `cause`.
struct Row {
  std::string cause, felt, worst, within, after;
};
Row row_of(const std::string& cause) {
  std::ifstream page(PALPATE_SOURCE_DIR "/docs/faults.md");
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| ") || line.find(cause) == std::string::npos) continue;
    std::vector<std::string> cell;
    for (std::size_t from = 2; from < line.size();) {
      const std::size_t to = line.find(" |", from);
      cell.push_back(line.substr(from, to - from));
      from = to == std::string::npos ? line.size() : to + 3;
    }
    if (cell.size() == 5) return {cell[0], cell[1], cell[2], cell[3], cell[4]};
  }
  ADD_FAILURE() << "docs/faults.md has no row \"" << cause << "\"";
  return {};
}

// Ticks since the fault, which comes in tick 1; 0: never. `zero`: the first from which the force stays zero.
struct Reaction {
  std::size_t latched = 0, zero = 0;
  std::uint32_t fault = 0;
};
Reaction reaction_of(const FaultRun& run) {
  Reaction r;
  const std::size_t size = run.records.size();
  for (std::size_t i = kTick; i < size && r.latched == 0; ++i)
    if (run.records[i].output.fault != 0) r.latched = i - kTick + 1, r.fault = run.records[i].output.fault;
  std::size_t last = size;
  while (last > kTick && run.records[last - 1].output.device_w == Wrench{}) --last;
  r.zero = last < size ? last - kTick + 1 : 0;
  return r;
}

// "latched at once" or "latched at tick N", "zero by tick M".
std::size_t said(const std::string& within, const std::string& what) {
  std::smatch found;
  if (!std::regex_search(within, found, std::regex(what + " (at once|(?:at|by) tick ([0-9]+))"))) {
    ADD_FAILURE() << "\"" << within << "\" does not say when it is " << what;
    return 0;
  }
  return found[1] == "at once" ? 1 : std::stoul(found[2]);
}

std::string name_of(std::uint32_t faults) {
  std::string names;
#define PALPATE_NAME(name, bit, cause, remedy) \
  if ((faults & 1u << bit) != 0) names += (names.empty() ? "" : ", ") + std::string("`" #name "`");
  PALPATE_FAULT_BITS(PALPATE_NAME)
#undef PALPATE_NAME
  return names;
}

void expect_as_the_page_says(const std::string& cause, const FaultRun& run) {
  SCOPED_TRACE(cause);
  const Row row = row_of(cause);
  const Reaction r = reaction_of(run);
  EXPECT_TRUE(row.worst.starts_with("Fault, ") && row.worst.find(name_of(r.fault)) != std::string::npos) << r.fault;
  EXPECT_EQ(r.latched, said(row.within, "latched"));
  EXPECT_EQ(r.zero, said(row.within, "zero"));
}

FaultRun attacked(const Attacker& attacker, std::uint64_t ticks = 1500) {
  VirtualClock clock;
  EvilDevice device(clock, kTick, attacker);
  return test::run_on(device, clock, ticks);
}

FaultRun meddled(const Meddle& meddle) { return run_with_faults("", 1500, WireProfile::kFd, 2e4, meddle); }

// Ticks whose computing takes `periods` and a half.
Meddle slow_ticks(std::uint64_t number, std::int64_t periods) {
  return [=](const Surroundings& s) {
    if (s.tick >= kTick && s.tick < kTick + number) s.clock.advance(periods * 1'000'000 + 500'000);
  };
}

TEST(FaultPage, OfScripts) {
  for (const char* script : {"lose 20", "silence 1", "unplug 1"})
    expect_as_the_page_says("20 lost, silence, cable out", run_with_faults(at_fault(script)));
  expect_as_the_page_says("encoder jump beyond 40 mm", run_with_faults(at_fault("jump 100")));
  expect_as_the_page_says("restarts for longer", run_with_faults(at_fault("restart 0.3")));
  expect_as_the_page_says("| bus-off", run_with_faults(at_fault("bus-off")));
  expect_as_the_page_says("no command arrives for longer", run_with_faults(at_fault("deaf 0.5")));
  expect_as_the_page_says("emergency stop at the device", run_with_faults(at_fault("stop 0.1")));
}

TEST(FaultPage, OfWhatADeviceSays) {
  expect_as_the_page_says("quaternions that are no rotation", attacked([](Attack& a) {
                            for (auto& q : a.status.quaternion) q = 0;
                          }));
  expect_as_the_page_says("calibration lost", attacked([](Attack& a) { a.status.flags &= ~DeviceFlag::kCalibrated; }));
  expect_as_the_page_says("too few samples", attacked([](Attack& a) { a.send = a.since % 2 == 0; }, 2000));
}

TEST(FaultPage, OfTheController) {
  expect_as_the_page_says("ticks missed 10 times in a row", meddled(slow_ticks(10, 2)));
  expect_as_the_page_says("20 ticks missed at once", meddled(slow_ticks(1, 20)));
  expect_as_the_page_says("force or state not finite", meddled([](const Surroundings& s) {
                            if (s.tick == kTick) s.params.coupling_N_per_m = std::numeric_limits<double>::quiet_NaN();
                          }));
  expect_as_the_page_says("host writes garbage", meddled([](const Surroundings& s) {
                            if (s.tick < kTick) return;
                            s.host_lives = false;
                            s.mailbox.word[1].store(~0ull);
                          }));
}

const char* word_of(Mode passing) {
  if (passing == Mode::kHold) return "Hold";
  if (passing == Mode::kPassive) return "Passive";
  return passing == Mode::kRamp ? "Ramp" : "Force";
}

// Those that pass say how long the force is not rendered as it should be.
void expect_passing(const std::string& cause, const FaultRun& run, std::size_t ticks) {
  SCOPED_TRACE(cause);
  const test::Disturbance d = test::disturbance(run);
  EXPECT_EQ(d.ticks, ticks);
  EXPECT_EQ(run.summary.faults, 0u);
  const std::string worst = row_of(cause).worst;  // "Hold to Ramp": by how far it turned
  EXPECT_TRUE(worst.find(word_of(d.worst)) != std::string::npos || worst == "Hold to Ramp") << worst;
}
std::size_t ticks_said(const std::string& cause) { return std::stoul(row_of(cause).within); }

TEST(FaultPage, OfWhatPasses) {
  const auto of = [](const std::string& cause, const std::string& script) {
    expect_passing(cause, run_with_faults(at_fault(script)), ticks_said(cause));
  };
  of("1 sample lost", "lose 1");
  of("up to 19 lost", "lose 19");
  of("duplicated", "duplicate 20");
  of("reordered", "reorder 1");
  of("up to 2 mm a tick", "jump 1.5");
  of("restarts in motion", "restart 0.01");
  of("device clock fast", "drift 4000");
  EXPECT_EQ(row_of("2 or 5 lost").within, "2, 5 ticks");
  for (const std::size_t n : {2u, 5u})
    expect_passing("2 or 5 lost", run_with_faults(at_fault("lose " + std::to_string(n))), n);
  for (const std::size_t n : {3u, 4u, 7u}) {
    expect_passing("delayed by N ticks", run_with_faults(at_fault("delay " + std::to_string(n))), n);
    expect_passing("corrupted", run_with_faults(at_fault("corrupt " + std::to_string(n))), n);
  }
  EXPECT_EQ(row_of("encoder jump of J mm").within, "J / 2 ticks");
  for (const std::size_t mm : {5u, 15u, 31u})
    expect_passing("encoder jump of J mm", run_with_faults(at_fault("jump " + std::to_string(mm))), mm / 2);
  EXPECT_EQ(ticks_said("sample numbers start anew"), 3u);
  expect_passing("sample numbers start anew", run_with_faults(at_fault("sequence")), 3);
}

// An orientation that turns at once by an angle is allowed after so many ticks as 30 rad/s take for it.
TEST(FaultPage, OfATurn) {
  EXPECT_EQ(row_of("turn faster than").within, "its angle / 0.03 rad");
  for (const double angle_rad : {0.1, 0.25, 0.4}) {
    const FaultRun run = attacked([=](Attack& a) {
      a.status.quaternion[0] = static_cast<std::int32_t>(32767 * std::cos(angle_rad / 2));
      a.status.quaternion[1] = a.status.quaternion[2] = 0;
      a.status.quaternion[3] = static_cast<std::int32_t>(32767 * std::sin(angle_rad / 2));
    });
    expect_passing("turn faster than", run, static_cast<std::size_t>(angle_rad / 0.03));
  }
}

}  // namespace
}  // namespace palpate
