// The doctor on made-up machines: a good one passes every item, and each item alone, spoiled, fails with its remedy.
#include <gtest/gtest.h>

#include <fstream>

#include "hal/bus/device_address.h"
#include "hal/system/device_lock.h"
#include "sim_host/doctor/doctor.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

class MadeUpMachine : public testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(root_);
    put("sys/kernel/realtime", "1");
    put("sys/devices/system/cpu/isolated", "2-3");
    put("proc/cmdline", "quiet isolcpus=2-3 nohz_full=2-3 rcu_nocbs=2-3");
    put("proc/sys/kernel/sched_rt_runtime_us", "-1");
    put("proc/sys/kernel/watchdog", "1");
    put("proc/sys/kernel/watchdog_cpumask", "0-1");
    put("proc/zoneinfo", "cpu: 3\n count: 234\n high: 252\n batch: 63");
    put("sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "performance");
    put("sys/devices/system/cpu/cpu3/topology/thread_siblings_list", "3");
    put("dev/cpu_dma_latency", "");
    put("sys/kernel/mm/transparent_hugepage/enabled", "always [madvise] never");
    put("proc/swaps", "Filename Type Size Used Priority");
    put("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
    put("proc/77/comm", "irq/16-can0");
    std::string stat = "77 (irq/16-can0) S";
    for (int field = 4; field <= 37; ++field) stat += " 0";
    put("proc/77/stat", stat + " 17 3 85 1");  // exit signal, processor, rt_priority (field 40), policy
    sources_.root = root_;
    sources_.cpu = 3;
    sources_.run = [this](const std::string&) { return link_; };
  }
  void put(const std::string& path, const std::string& line) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << line << '\n';
  }
  static const DoctorItem* find(const std::vector<DoctorItem>& items, const std::string& name) {
    for (const DoctorItem& item : items)
      if (item.name == name) return &item;
    return nullptr;
  }

  fs::path root_;
  DoctorSources sources_;
  std::string link_ = R"([{"ifname":"can0","flags":["NOARP","UP"],"mtu":16,"qdisc":"pfifo_fast","txqlen":10,
      "linkinfo":{"info_kind":"can","info_data":{"restart_ms":0,"bittiming":{"bitrate":1000000}}}}])";
};

TEST_F(MadeUpMachine, AGoodMachinePasses) {
  for (const DoctorItem& item : examine_machine(sources_)) {
    if (item.name.find("limit") != std::string::npos) continue;  // of the process that runs the test
    EXPECT_EQ(item.verdict, Verdict::kPass) << item.name << ": " << item.found;
    EXPECT_TRUE(item.remedy.empty()) << item.name;
  }
}

TEST_F(MadeUpMachine, EachSpoiledItemFailsWithARemedy) {
  struct Spoil {
    const char* path;
    const char* line;
    const char* item;
  };
  const Spoil spoils[] = {
      {"sys/kernel/realtime", "0", "PREEMPT_RT kernel"},
      {"sys/devices/system/cpu/isolated", "1", "isolated CPU"},
      {"proc/cmdline", "quiet rcu_nocbs=2", "boot option nohz_full"},
      {"proc/cmdline", "quiet nohz_full=2", "boot option rcu_nocbs"},
      {"proc/sys/kernel/sched_rt_runtime_us", "950000", "real-time throttling off"},
      {"proc/sys/kernel/watchdog_cpumask", "0-3", "lockup watchdog off the real-time CPU"},
      {"proc/zoneinfo", "high: 18\n batch: 1\n high: 1186\n batch: 63", "short lists of free pages"},
      {"proc/zoneinfo", "high: 252\n batch: 63\n high_min: 252\n high_max: 30000", "short lists of free pages"},
      {"sys/fs/cgroup/cpu/cpu.rt_runtime_us", "0", "real-time group scheduling"},
      {"sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "powersave", "CPU governor"},
      {"sys/devices/system/cpu/cpu3/topology/thread_siblings_list", "3,7", "no SMT sibling on the real-time CPU"},
      {"sys/kernel/mm/transparent_hugepage/enabled", "[always] madvise never", "transparent huge pages not forced"},
      {"proc/swaps", "Filename\n/dev/sda2 partition 1 0 -2", "no swap"},
      {"sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet", "clock source tsc"},
  };
  for (const Spoil& spoil : spoils) {
    SetUp();
    put(spoil.path, spoil.line);
    const auto items = examine_machine(sources_);
    const DoctorItem* item = find(items, spoil.item);
    ASSERT_NE(item, nullptr) << spoil.item;
    EXPECT_EQ(item->verdict, Verdict::kFail) << spoil.item << ": " << item->found;
    EXPECT_FALSE(item->remedy.empty()) << spoil.item;
  }
}

TEST_F(MadeUpMachine, WhatCannotBeReadIsUnknown) {
  fs::remove_all(root_ / "proc/sys");
  const auto items = examine_machine(sources_);
  EXPECT_EQ(find(items, "real-time throttling off")->verdict, Verdict::kUnknown);
}

TEST_F(MadeUpMachine, AWatchdogThatIsOffDisturbsNoProcessor) {
  put("proc/sys/kernel/watchdog", "0");
  put("proc/sys/kernel/watchdog_cpumask", "0-3");
  EXPECT_EQ(find(examine_machine(sources_), "lockup watchdog off the real-time CPU")->verdict, Verdict::kPass);
}

TEST_F(MadeUpMachine, CanCardOfTheLoopIsJudged) {
  for (const DoctorItem& item : examine_device(sources_, "can:can0"))
    EXPECT_NE(item.verdict, Verdict::kFail) << item.name << ": " << item.found;
  sources_.loop_priority = 90;  // above the interrupt thread's 85
  EXPECT_EQ(find(examine_device(sources_, "can:can0"), "interrupt thread above the loop")->verdict, Verdict::kFail);

  link_ = R"([{"ifname":"can0","flags":["NOARP"],"mtu":16,"qdisc":"fq_codel","txqlen":1000,
      "linkinfo":{"info_kind":"can","info_data":{"restart_ms":100,"bittiming":{"bitrate":125000}}}}])";
  const auto items = examine_device(sources_, "can:can0");
  for (const char* name : {"CAN interface can0", "queue discipline", "bit rate",
                           "stays bus-off until the operator acts", "short transmit queue"})
    EXPECT_EQ(find(items, name)->verdict, Verdict::kFail) << name;
}

// An address as `palpate run` takes it; classic frames need no FD.
TEST_F(MadeUpMachine, TheAddressMayHaveOptions) {
  for (const char* address : {"can:can0,classic", "can:can0,classic,node=3", "can:can0,node=15"}) {
    const std::vector<DoctorItem> items = examine_device(sources_, address);
    EXPECT_EQ(find(items, "CAN interface can0")->verdict, Verdict::kPass) << address;
    EXPECT_EQ(find(items, "MTU for CAN FD") == nullptr, std::string(address).find("classic") != std::string::npos);
  }
  const std::vector<DoctorItem> wrong = examine_device(sources_, "can:can0,clasic");
  EXPECT_EQ(wrong[0].verdict, Verdict::kFail);
  EXPECT_NE(wrong[0].found.find("clasic"), std::string::npos) << wrong[0].found;
}

// Two that command one node are both obeyed: whoever has the device keeps it.
TEST(DeviceInUse, IsSaidByDoctorAndDeviceTest) {
  std::string error;
  const DeviceLock held = DeviceLock::take("can-palpatetest0-node7", error);
  ASSERT_TRUE(held) << error;
  const std::vector<DoctorItem> heard = listen_to_device("can:palpatetest0,node=7");
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].verdict, Verdict::kUnknown);
  EXPECT_NE(heard[0].found.find("is in use by"), std::string::npos) << heard[0].found;
  EXPECT_EQ(listen_to_device("can:palpatetest0,node=6")[0].found.find("is in use by"), std::string::npos);
  DeviceAddress usb;
  usb.kind = TransportKind::kUsb;
  usb.name = "/dev/./null";
  EXPECT_EQ(lock_name(usb), "usb/dev/null") << "one lock for every name of a device";
  EXPECT_EQ(lock_name({}), "");
}

TEST_F(MadeUpMachine, UnknownInterfacesAndNamesThatAreNoneFail) {
  link_ = "";
  EXPECT_EQ(examine_device(sources_, "can:can9")[0].verdict, Verdict::kFail);
  bool ran = false;
  sources_.run = [&ran](const std::string&) { return ran = true, std::string{}; };
  EXPECT_EQ(examine_device(sources_, "can:can0; reboot")[0].verdict, Verdict::kFail);
  EXPECT_FALSE(ran) << "a name that is none must never reach a shell";
}

}  // namespace
}  // namespace palpate::test
