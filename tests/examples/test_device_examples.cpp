// The devices of docs/examples, as programs: the controller meets nothing of theirs but frames. Graded rule by rule and
// pressed into a scene in virtual time; then started as a reader would start them.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <time.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hal/bus/loopback.h"
#include "hal/bus/usb_hid.h"
#include "hal/loop/lockstep.h"
#include "sim_host/doctor/device_test.h"
#include "sim_host/run/process.h"
#include "sim_host/run/run_session.h"
#include "sim_host/run/socket_pair.h"

namespace palpate {
namespace {

constexpr int kLongest_ms = 10'000;  // of a process to start or to end; it waits no longer than it takes

// How it is started, by itself and in lock step: a shell's words.
struct Example {
  const char* name;
  const char* command;
  const char* in_lockstep;
};

void PrintTo(const Example& example, std::ostream* out) { *out << example.name; }

// A folder of programs: the controller's, and a device that is a shell's words.
class ExampleFolder {
 public:
  ExampleFolder() {
    folder_ = std::filesystem::temp_directory_path() / ("palpate_example_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    const std::filesystem::path bin =
        std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "bin";
    std::filesystem::create_symlink(bin / "palpate-rt", folder_ / "palpate-rt");
  }
  ~ExampleFolder() { std::filesystem::remove_all(folder_); }
  ExampleFolder(const ExampleFolder&) = delete;
  ExampleFolder& operator=(const ExampleFolder&) = delete;
  const std::filesystem::path& path() const { return folder_; }
  std::string script(const std::string& name, const std::string& command) const {
    const std::filesystem::path file = folder_ / name;
    std::ofstream(file) << "#!/bin/sh\nexec " << command << " \"$@\"\n";
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return file.string();
  }

 private:
  std::filesystem::path folder_;
};

class DeviceExample : public testing::TestWithParam<Example> {
 protected:
  ExampleFolder folder_;
  std::string in_lockstep_ = folder_.script("palpate-device", GetParam().in_lockstep);
};

// Both ends of a socket are a gadget's: plain reports of 64 bytes, without the number that hidraw wants first.
std::unique_ptr<Transport> usb_over(int fd) {
  fcntl(fd, F_SETFL, O_NONBLOCK);
  return std::make_unique<UsbHid>(fd, UsbSide::kDevice);
}

// The rules of `palpate device-test`, in the controller's virtual time. `untold`: rows that the profile cannot tell.
// `as_usb`: the wire carries the reports of USB.
void keeps_every_rule(const std::string& program, WireProfile profile, int untold, bool as_usb = false) {
  SocketPair wire, turns;
  Process device =
      Process::start(program, {"--device-fd", "3", "--turn-fd", "4"}, {{wire.end(1), 3}, {turns.end(1), 4}});
  wire.close_end(1);
  turns.close_end(1);
  std::string error;
  const int mine = dup(wire.end(0));
  std::unique_ptr<Transport> transport = as_usb ? usb_over(mine) : adopt_loopback(mine, error);
  wire.close_end(0);
  ASSERT_TRUE(transport) << error;
  LockstepClock clock;
  clock.add(turns.end(0), "device");
  std::int64_t now_ns = 0;
  const std::vector<DoctorItem> rows =
      DeviceTest(*transport, profile, 1, [&] { clock.wait_until(now_ns += 1'000'000); }).run();
  EXPECT_EQ(rows.size(), 21u);
  for (const DoctorItem& row : rows) {
    if (row.verdict == Verdict::kUnknown && untold-- > 0) continue;
    EXPECT_EQ(row.verdict, Verdict::kPass) << row.name << ": " << row.found;
  }
  EXPECT_EQ(clock.lost(), nullptr);
  transport.reset();
  turns.close_end(0);
  ASSERT_TRUE(device.wait(kLongest_ms));
  EXPECT_EQ(device.exit_code(), 0);
}

TEST_P(DeviceExample, KeepsEveryRuleOfTheWireProtocol) { keeps_every_rule(in_lockstep_, WireProfile::kFd, 0); }

// Its hand presses for a second and withdraws in another: one period of the motion, and half a second of the next.
void presses_and_withdraws(const ExampleFolder& folder, const std::vector<std::string>& settings) {
  RunOptions options;
  options.overlays.setting = settings;
  options.scene = PALPATE_SOURCE_DIR "/config/scenes/ellipsoid_mallet.toml";
  options.image = (folder.path() / "mallet.pal").string();
  options.record = "";
  options.device = "loopback";
  options.time = RunTime::kVirtual;
  options.duration_s = 2.5;
  options.priority = 0;
  options.quiet = true;
  options.program_folder = folder.path().string();
  double pressed_N = 0, withdrawn_N = 0;
  options.companion.tick = [&](const TickRecord& record) {
    const double force_N = norm(record.output.device_w.force_N);
    if (record.sequence > 800 && record.sequence < 1200) pressed_N = std::max(pressed_N, force_N);
    if (record.sequence > 1900 && record.sequence < 2100) withdrawn_N = std::max(withdrawn_N, force_N);
  };
  const RunResult result = run_session(options);
  EXPECT_EQ(result.summary.fault, 0u);
  EXPECT_EQ(result.controller_exit, 0);
  EXPECT_FALSE(result.device_died);
  EXPECT_EQ(result.summary.missed_ticks + result.summary.stale_ticks + result.lost, 0u);
  EXPECT_GT(result.summary.ticks, 2400u);
  // The hand aims 10 mm below the first touch with 0.8 N/mm: less than 8 N, and about half where the body is as stiff.
  EXPECT_GT(pressed_N, 2);
  EXPECT_LT(pressed_N, 8);
  EXPECT_LT(withdrawn_N, 0.05);  // 18 mm clear of the body: nothing but what the coupling carries of the motion
}

TEST_P(DeviceExample, PressesAndWithdrawsWithoutAFault) { presses_and_withdraws(folder_, {}); }

TEST_P(DeviceExample, StartsAndEndsAsAReaderStartsIt) {
  const std::string name = "palpate-example-" + std::to_string(getpid());
  Process device = Process::start(folder_.script("example", GetParam().command), {name}, {});
  std::string error;
  std::unique_ptr<Transport> transport = accept_loopback(name, kLongest_ms, error);
  ASSERT_TRUE(transport) << error;
  DeviceBus bus(*transport, WireProfile::kFd);
  DeviceSample sample;
  for (int waited_ms = 0; waited_ms < kLongest_ms && bus.counters().accepted < 20; ++waited_ms) {
    const timespec step{0, 1'000'000};
    nanosleep(&step, nullptr);
    bus.receive(sample);
    bus.transmit({});
  }
  EXPECT_GE(bus.counters().accepted, 20u);
  EXPECT_EQ(bus.first_reason(), DropReason::kNone);
  EXPECT_EQ(bus.counters().clock, 0u);  // forwards; a test that stood still would lose samples
  EXPECT_EQ(bus.newest().flags, DeviceFlag::kCalibrated | DeviceFlag::kWatchdog);  // never enabled
  transport.reset();
  ASSERT_TRUE(device.wait(kLongest_ms));
  EXPECT_EQ(device.exit_code(), 0);
}

std::string name_of(const testing::TestParamInfo<Example>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(C, DeviceExample,
                         testing::Values(Example{"device_c", PALPATE_C_DEVICE, PALPATE_C_LOCKSTEP},
                                         Example{"device_kit_c", PALPATE_C_KIT, PALPATE_C_KIT_LOCKSTEP}),
                         name_of);
// The firmware's node has no socket of its own: in lock step alone. With its local model and without.
TEST(FirmwareNode, KeepsEveryRuleOfTheWireProtocol) {
  const ExampleFolder folder;
  keeps_every_rule(folder.script("palpate-device", PALPATE_FIRMWARE), WireProfile::kFd, 0);
  keeps_every_rule(folder.script("palpate-device", PALPATE_FIRMWARE " 3000"), WireProfile::kFd, 0);
}

TEST(FirmwareNode, PressesAndWithdrawsWithAndWithoutItsLocalModel) {
  const ExampleFolder folder;
  folder.script("palpate-device", PALPATE_FIRMWARE);
  presses_and_withdraws(folder, {});
  folder.script("palpate-device", PALPATE_FIRMWARE " 3000");
  presses_and_withdraws(folder, {"device.local_kHz=10"});
}

#ifdef PALPATE_PYTHON3
#define PALPATE_EXAMPLE PALPATE_PYTHON3 " " PALPATE_SOURCE_DIR "/docs/examples/"
#define PALPATE_LOCKSTEP PALPATE_PYTHON3 " " PALPATE_SOURCE_DIR "/tests/examples/lockstep_device.py "
#define PALPATE_KIT "env PYTHONPATH=" PALPATE_SOURCE_DIR "/sim_host/python " PALPATE_EXAMPLE "device_kit.py loopback:$1"
INSTANTIATE_TEST_SUITE_P(Python, DeviceExample,
                         testing::Values(Example{"device_py", PALPATE_EXAMPLE "device.py", PALPATE_LOCKSTEP "device"},
                                         Example{"device_kit_py", PALPATE_KIT, PALPATE_LOCKSTEP "device_kit"}),
                         name_of);
TEST(UsbExample, KeepsEveryRuleOfTheWireProtocol) {
  const ExampleFolder folder;
  keeps_every_rule(folder.script("palpate-device", PALPATE_LOCKSTEP "device_kit_usb"), WireProfile::kFd, 0, true);
}
// The kit speaks classic frames too, which carry no time.
TEST(ClassicExample, KeepsEveryRuleOfTheWireProtocol) {
  const ExampleFolder folder;
  const std::string program = folder.script("palpate-device", PALPATE_LOCKSTEP "device_kit_classic");
  keeps_every_rule(program, WireProfile::kClassic, 1);
}
#endif

}  // namespace
}  // namespace palpate
