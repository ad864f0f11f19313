// The conformance test of devices: the project's own node keeps every rule in both profiles, and for each rule there is
// a node that breaks it and is told so. In virtual time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "hal/bus/link_report.h"
#include "hal/bus/loopback.h"
#include "hal/device/device_node.h"
#include "sim_host/doctor/device_test.h"

namespace palpate {
namespace {

using testing::HasSubstr;

// What a faulty firmware does to its statuses and commands; FD profile. Returning false drops the frame.
struct Breakage {
  std::function<bool(wire::Status&)> status;
  std::function<void(Frame&)> sealed_status;
  std::function<bool(Frame&)> command;
  bool oldest_first = false;  // of several commands at once, keeps the first number
  std::int64_t watchdog_ns = 20'000'000;
};

class BrokenWire : public Transport {
 public:
  BrokenWire(Transport& inner, Breakage breakage) : inner_(inner), breakage_(std::move(breakage)) {}
  int send(std::span<const Frame> frames) noexcept override {
    Frame out[2] = {frames[0], frames[0]};
    wire::Status status;
    if (breakage_.status && wire::decode({frames[0].data, frames[0].length}, 1, status) == wire::DecodeResult::kOk) {
      if (!breakage_.status(status)) return 1;
      make_status_frames(1, status, out);
    }
    if (breakage_.sealed_status) breakage_.sealed_status(out[0]);
    if (!breakage_.status && !breakage_.sealed_status) return inner_.send(frames);
    return inner_.send({out, 1});
  }
  int receive(std::span<Frame> frames) noexcept override {
    const int count = inner_.receive(frames);
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      Frame frame = frames[static_cast<std::size_t>(i)];
      if (breakage_.oldest_first && i + 1 < count) continue;
      if (!breakage_.command || breakage_.command(frame)) frames[static_cast<std::size_t>(kept++)] = frame;
    }
    return kept;
  }
  TransportState state() const noexcept override { return inner_.state(); }
  const TransportCounters& counters() const noexcept override { return inner_.counters(); }

 private:
  Transport& inner_;
  Breakage breakage_;
};

std::vector<DoctorItem> graded(const Breakage& breakage, WireProfile profile = WireProfile::kFd) {
  std::string error;
  const auto pair = open_loopback_pair(error);
  BrokenWire wire(*pair.second, breakage);
  NodeOptions options;
  options.profile = profile;
  options.watchdog_ns = breakage.watchdog_ns;
  DeviceNode node(wire, options, {}, HandPath({{0, {{0.01, 0.02, -0.03}, {}}}}));
  std::int64_t now_ns = 0;
  DeviceTest test(*pair.first, profile, 1, [&] { node.step(now_ns += 1'000'000); });
  const std::vector<DoctorItem> rows = test.run();
  EXPECT_EQ(node.plant().motor().force_N, Vec3{});
  return rows;
}

void reseal(Frame& frame) {
  frame.length = 20;
  const std::uint8_t head[2] = {static_cast<std::uint8_t>(frame.id & 0xFF), static_cast<std::uint8_t>(frame.id >> 8)};
  const std::uint16_t crc = wire::crc16({frame.data, 18}, wire::crc16(head));
  frame.data[18] = static_cast<std::uint8_t>(crc & 0xFF);
  frame.data[19] = static_cast<std::uint8_t>(crc >> 8);
}

std::uint32_t number_of(const Frame& frame) { return frame.data[0] | static_cast<std::uint32_t>(frame.data[1]) << 8; }

TEST(DeviceTest, TheProjectsNodeKeepsEveryRule) {
  for (const WireProfile profile : {WireProfile::kFd, WireProfile::kClassic}) {
    const std::vector<DoctorItem> rows = graded({}, profile);
    EXPECT_EQ(rows.size(), 21u);
    for (const DoctorItem& row : rows) {
      EXPECT_NE(row.verdict, Verdict::kFail) << row.name << ": " << row.found;
      EXPECT_EQ(row.verdict == Verdict::kUnknown, profile == WireProfile::kClassic && row.name == "device clock runs")
          << row.name;
      EXPECT_EQ(row.remedy, "") << row.name;
    }
  }
}

struct Case {
  const char* rule;
  Breakage breakage;
};

std::vector<Case> broken_sending() {
  std::vector<Case> cases;
  const auto status = [&](const char* rule, std::function<bool(wire::Status&)> spoil) {
    cases.push_back({rule, {std::move(spoil), {}, {}}});
  };
  status("samples arrive", [n = 0](wire::Status&) mutable { return ++n % 3 != 0; });
  status("samples are numbered in order", [](wire::Status& s) {
    s.sequence |= 1;
    return true;
  });
  cases.push_back(
      {"frames are well formed",
       {{},
        [n = 0](Frame& f) mutable { f.data[9] = static_cast<std::uint8_t>(f.data[9] ^ (++n % 20 == 0 ? 4 : 0)); },
        {}}});
  status("orientation is a rotation", [](wire::Status& s) {
    for (std::int32_t& q : s.quaternion) q = 0;
    return true;
  });
  status("device clock runs", [](wire::Status& s) {
    s.time_us = 5;
    return true;
  });
  status("calibrated", [](wire::Status& s) {
    s.flags &= ~DeviceFlag::kCalibrated;
    return true;
  });
  status("no error, no emergency stop", [](wire::Status& s) {
    s.flags |= DeviceFlag::kError;
    s.error = 9;
    return true;
  });
  status("drives are off unless enabled", [](wire::Status& s) {
    s.flags |= DeviceFlag::kEnabled;
    return true;
  });
  status("echoes the command it obeys", [](wire::Status& s) {
    s.command_sequence = 0;
    return true;
  });
  status("enables on 0 -> 1", [](wire::Status& s) {
    s.flags &= ~DeviceFlag::kEnabled;
    return true;
  });
  status("disables on 0", [on = false](wire::Status& s) mutable {
    on = on || (s.flags & DeviceFlag::kEnabled) != 0;
    if (on) s.flags |= DeviceFlag::kEnabled;
    return true;
  });
  status("is enabled anew by 0 -> 1", [enabled = false, tripped = false](wire::Status& s) mutable {
    enabled = enabled || (s.flags & DeviceFlag::kEnabled) != 0;
    tripped = tripped || (enabled && (s.flags & DeviceFlag::kWatchdog) != 0);
    if (tripped) s.flags = (s.flags | DeviceFlag::kWatchdog) & ~DeviceFlag::kEnabled;
    return true;
  });
  return cases;
}

// A node of protocol 1: its watchdog passes with the next command.
Breakage forgetful() {
  auto heard = std::make_shared<int>(0);
  Breakage breakage;
  breakage.command = [heard](Frame&) {
    *heard = 3;
    return true;
  };
  breakage.status = [heard](wire::Status& s) {
    if (--*heard > 0) s.flags = (s.flags & ~DeviceFlag::kWatchdog) | DeviceFlag::kEnabled;
    return true;
  };
  return breakage;
}

// A node that takes whatever number came last for the newest.
Breakage gullible() {
  auto last = std::make_shared<std::uint32_t>(0);
  Breakage breakage;
  breakage.command = [last](Frame& f) {
    *last = number_of(f);
    return true;
  };
  breakage.status = [last](wire::Status& s) {
    s.command_sequence = *last;
    return true;
  };
  return breakage;
}

std::vector<Case> broken_listening() {
  std::vector<Case> cases;
  const auto command = [&](const char* rule, std::function<bool(Frame&)> spoil) {
    cases.push_back({rule, {{}, {}, std::move(spoil)}});
  };
  command("follows after lost commands", [last = 0u](Frame& f) mutable {
    if (last != 0 && number_of(f) > last + 1) return false;  // wants +1 and nothing else
    last = number_of(f);
    return true;
  });
  cases.push_back({"obeys the newest of a burst", {}});
  cases.back().breakage.oldest_first = true;
  cases.push_back({"refuses repeated and old commands", gullible()});
  command("refuses a wrong checksum", [](Frame& f) {
    if (f.id == 0x101 && f.length == 20) reseal(f);
    return true;
  });
  command("refuses a wrong length", [](Frame& f) {
    if (f.length == 16) reseal(f);
    return true;
  });
  command("refuses another node's command", [](Frame& f) {
    if (f.id != 0x101) {
      f.id = 0x101;
      reseal(f);
    }
    return true;
  });
  cases.push_back({"lets go without commands", {}});
  cases.back().breakage.watchdog_ns = 500'000'000;
  cases.push_back({"stays so until enabled anew", forgetful()});
  command("follows a controller that starts again", [most = 0u](Frame& f) mutable {
    if (number_of(f) + 100 < most) return false;
    most = std::max(most, number_of(f));
    return true;
  });
  return cases;
}

TEST(DeviceTest, EveryRuleHasANodeThatBreaksIt) {
  std::set<std::string> rules;
  for (const auto& cases : {broken_sending(), broken_listening()}) {
    for (const Case& c : cases) {
      bool failed = false;
      for (const DoctorItem& row : graded(c.breakage)) {
        if (row.name != c.rule) continue;
        failed = row.verdict == Verdict::kFail;
        EXPECT_NE(row.remedy, "") << c.rule;
      }
      EXPECT_TRUE(failed) << c.rule;
      rules.insert(c.rule);
    }
  }
  for (const DoctorItem& row : graded({})) EXPECT_TRUE(rules.contains(row.name)) << row.name;
}

TEST(DeviceTest, ASilentDeviceIsOneRowThatSaysSo) {
  std::string error;
  const auto pair = open_loopback_pair(error);
  int waits = 0;
  const std::vector<DoctorItem> rows = DeviceTest(*pair.first, WireProfile::kFd, 1, [&] { waits += 1; }).run();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].verdict, Verdict::kFail);
  EXPECT_THAT(rows[0].found, HasSubstr("no frame came"));
  EXPECT_THAT(rows[0].remedy, HasSubstr("check power"));
  EXPECT_LT(waits, 4000);
}

// What a run that gets no usable sample says; 3,000 frames with a bad checksum were once "nothing: check the cable".
struct Reported {
  explicit Reported(WireProfile profile = WireProfile::kFd, int node = 1)
      : pair(open_loopback_pair(error)), bus(*pair.first, profile, node) {}
  LinkReport after(const Frame& frame, int times) {
    DeviceSample sample;
    for (int i = 0; i < times; ++i) {
      pair.second->send({&frame, 1});
      bus.receive(sample);
    }
    return report_link(bus, pair.first->state());
  }
  std::string error;
  std::pair<std::unique_ptr<Transport>, std::unique_ptr<Transport>> pair;
  DeviceBus bus;
};

Frame good_status(std::uint32_t flags = DeviceFlag::kCalibrated, int node = 1, std::uint32_t version = wire::kVersion) {
  wire::Status status;
  status.flags = flags;
  status.version = version;
  wire::set_pose(status, {}, {});
  Frame frames[2];
  make_status_frames(node, status, frames);
  return frames[0];
}

TEST(LinkReport, SaysHowManyFramesWereDroppedAndWhyWithTheFirstOnesBytes) {
  Frame frame = good_status();
  frame.data[31] ^= 0xFF;
  const LinkReport report = Reported().after(frame, 3000);
  EXPECT_FALSE(report.good);
  EXPECT_THAT(report.found, HasSubstr("3000 frames came, 0 samples were used; dropped: 3000 with a wrong checksum"));
  EXPECT_THAT(report.found, HasSubstr("the first: 0x181, 32 bytes: 00 00 00 00 01"));
  EXPECT_THAT(report.remedy, HasSubstr("the firmware's checksum"));
  EXPECT_EQ(report.found.find("no frame"), std::string::npos);
}

TEST(LinkReport, NamesNodeProfileAndVersionThatWouldFit) {
  EXPECT_THAT(Reported().after(good_status(1, 3), 5).remedy, HasSubstr(",node=3"));
  EXPECT_THAT(Reported(WireProfile::kClassic).after(good_status(), 5).remedy, HasSubstr("leave ,classic out"));
  Frame classic;
  classic.id = wire::kClassicPositionId + 1;
  classic.length = 8;
  EXPECT_THAT(Reported().after(classic, 5).remedy, HasSubstr("add ,classic"));
  EXPECT_THAT(Reported().after(good_status(1, 1, 1), 5).remedy, HasSubstr("speaks protocol 1, this build 2"));
}

TEST(LinkReport, TellsAMissingCalibrationFromAnErrorAndAStop) {
  EXPECT_TRUE(Reported().after(good_status(), 1).good);
  const LinkReport lost = Reported().after(good_status(0), 1);
  EXPECT_FALSE(lost.good);
  EXPECT_THAT(lost.found, HasSubstr("flags: none"));
  EXPECT_THAT(lost.remedy, HasSubstr("calibrate the device: flag 1 is missing"));
  EXPECT_THAT(Reported().after(good_status(DeviceFlag::kCalibrated | DeviceFlag::kStopButton), 1).remedy,
              HasSubstr("emergency stop"));
  EXPECT_THAT(Reported().after(good_status(DeviceFlag::kCalibrated | DeviceFlag::kError), 1).remedy,
              HasSubstr("clear the device's error"));
}

TEST(LinkReport, ALineThatIsDownIsNotACableToCheck) {
  Reported reported;
  reported.pair.second.reset();
  DeviceSample sample;
  reported.bus.receive(sample);
  EXPECT_THAT(report_link(reported.bus, reported.pair.first->state()).found, HasSubstr("the other end closed"));
}

}  // namespace
}  // namespace palpate
