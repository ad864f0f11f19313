// The certification: durations, verdicts by their limits, the result's two forms, the machine's identity, and one short
// run of the real controller. What is checked is function, never time.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "hal/system/duration.h"
#include "sim_host/doctor/certify.h"

namespace palpate {
namespace {

TickRecord tick_of(std::uint64_t number, std::int32_t wake_ns) {
  TickRecord record{};
  record.tick = number;
  record.timing.deadline_ns = static_cast<std::int64_t>(number) * 1'000'000;
  record.timing.wake_latency_ns = wake_ns;
  record.timing.compute_ns = 20'000;
  return record;
}

std::unique_ptr<HostCertificate> good() {
  auto certificate = std::make_unique<HostCertificate>();
  certificate->options.duration_s = 10;
  certificate->run.elapsed_s = 10.02;
  for (std::uint64_t i = 0; i < 10'000; ++i) add(certificate->run.summary, tick_of(i, i == 777 ? 90'000 : 8'000));
  return certificate;
}

CertifyVerdict verdict_after(const std::function<void(HostCertificate&)>& change, const std::string& reason) {
  const auto certificate = good();
  change(*certificate);
  judge(*certificate);
  if (!reason.empty()) {
    EXPECT_EQ(certificate->reasons.size(), 1u) << reason;
    EXPECT_TRUE(!certificate->reasons.empty() && certificate->reasons[0].find(reason) != std::string::npos)
        << reason << ": " << (certificate->reasons.empty() ? "" : certificate->reasons[0]);
  } else {
    EXPECT_TRUE(certificate->reasons.empty());
  }
  return certificate->verdict;
}

TEST(Certify, DurationsAreReadStrictly) {
  EXPECT_EQ(parse_duration_s("1h"), 3600.0);
  EXPECT_EQ(parse_duration_s("10m"), 600.0);
  EXPECT_EQ(parse_duration_s("30s"), 30.0);
  EXPECT_EQ(parse_duration_s("1h30m"), 5400.0);
  EXPECT_EQ(parse_duration_s("2.5m"), 150.0);
  for (const char* bad : {"", "10", "h", "1d", "-1h", "1h x", "nan", "infs", "0s", "1e9h", "900h", "1h "}) {
    EXPECT_FALSE(parse_duration_s(bad)) << bad;
  }
}

TEST(Certify, EveryLimitFailsByItself) {
  const auto fail = CertifyVerdict::kFail;
  EXPECT_EQ(verdict_after([](HostCertificate&) {}, ""), CertifyVerdict::kPass);
  EXPECT_EQ(verdict_after([](HostCertificate& c) { c.run.summary.missed_ticks = 1; }, "1 deadlines missed"), fail);
  EXPECT_EQ(verdict_after([](HostCertificate& c) { add(c.run.summary, tick_of(10'000, 600'000)); },
                          "longest tick 620.0 us, 500.0 us allowed (tick 10000)"),
            fail);
  EXPECT_EQ(verdict_after([](HostCertificate& c) { c.options.limits.wake_us = 89; },
                          "latest wake-up 90.0 us, 89 us allowed (tick 777)"),
            fail);
  EXPECT_EQ(verdict_after([](HostCertificate& c) { c.options.limits.wake_us = 90; }, ""), CertifyVerdict::kPass);
  EXPECT_EQ(verdict_after([](HostCertificate& c) { c.run.summary.fault = Fault::kOverrun; }, "Overrun"), fail);
  EXPECT_EQ(verdict_after([](HostCertificate& c) { c.run.lost = 3; }, "3 ticks could not be measured"), fail);
  EXPECT_EQ(verdict_after([](HostCertificate& c) { c.run.summary.device_force_max_N = 0.1; }, "not zero"), fail);
  EXPECT_EQ(verdict_after([](HostCertificate& c) { c.run.controller_exit = 137; }, "exit code 137"), fail);
  EXPECT_EQ(verdict_after([](HostCertificate& c) { c.run.summary = {}; }, "no ticks"), fail);
}

TEST(Certify, AnEarlyEndIsIncompleteUnlessItFailedAlready) {
  EXPECT_EQ(verdict_after([](HostCertificate& c) { c.run.elapsed_s = 4; }, ""), CertifyVerdict::kIncomplete);
  EXPECT_EQ(verdict_after([](HostCertificate& c) { c.run.interrupted = true; }, ""), CertifyVerdict::kIncomplete);
  EXPECT_EQ(verdict_after(
                [](HostCertificate& c) {
                  c.run.interrupted = true;
                  c.run.summary.missed_ticks = 2;
                },
                "2 deadlines missed"),
            CertifyVerdict::kFail);
}

TEST(Certify, BothFormsCarryIdentityFiguresAndLimits) {
  const auto certificate = good();
  certificate->machine.cpu_model = "Made-up 9000";
  certificate->machine.kernel = "6.1.0-rt";
  certificate->machine.realtime_kernel = true;
  certificate->machine.checks = {{"isolated CPU", Verdict::kFail, "none", "boot with isolcpus"}};
  certificate->options.limits.wake_us = 100;
  certificate->options.host_load = true;
  certificate->start_s = 1'795'233'705;
  certificate->end_s = 1'795'233'715;
  judge(*certificate);
  const nlohmann::json root = nlohmann::json::parse(certificate_json(*certificate));
  EXPECT_EQ(root.at("verdict"), "PASS");
  EXPECT_EQ(root.at("start"), "Sat, 21 Nov 2026 04:01:45 +0000");
  EXPECT_EQ(root.at("machine").at("cpu_model"), "Made-up 9000");
  EXPECT_EQ(root.at("machine").at("preempt_rt"), true);
  EXPECT_EQ(root.at("machine").at("checks").at(0).at("verdict"), "fail");
  EXPECT_EQ(root.at("run").at("load"), "host");
  EXPECT_EQ(root.at("limits").at("wake_up_us"), 100.0);
  EXPECT_EQ(root.at("limits").at("whole_tick_us"), 500.0);
  EXPECT_EQ(root.at("ticks").at("count"), 10'000);
  const nlohmann::json& wake = root.at("stages").at("wake_up");
  EXPECT_DOUBLE_EQ(wake.at("max_us"), 90.0);
  EXPECT_EQ(wake.at("tick_of_max"), 777);
  EXPECT_NEAR(wake.at("p50_us"), 8.0, 8.0 / 64);  // one bucket
  EXPECT_EQ(root.at("stages").size(), 7u + kStageCount);
  EXPECT_EQ(root.at("worst_ticks").size(), static_cast<std::size_t>(kWorstTicksKept));
  EXPECT_EQ(root.at("worst_ticks").at(0).at("tick"), 777);
  const std::string text = certificate_text(*certificate);
  for (const char* part : {"PASS", "Made-up 9000", "PREEMPT_RT yes", "failing: isolated CPU", "wake-up at most 100 us",
                           "10000 at 1000.000 Hz", "whole tick", "load: host"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(Certify, NameHoldsHostAndDate) {
  EXPECT_EQ(certificate_name("my.host", 1'795'233'705), "palpate-latency-my-host-20261121T040145Z");
}

TEST(Certify, MachineIsReadFromItsFiles) {
  const auto root = std::filesystem::temp_directory_path() / ("palpate_machine_" + std::to_string(getpid()));
  const auto put = [&](const char* name, const std::string& text) {
    std::filesystem::create_directories((root / name).parent_path());
    std::ofstream(root / name) << text;
  };
  put("proc/cpuinfo",
      "processor\t: 0\nmodel name\t: Made-up 9000\nmicrocode\t: 0x12\n\nprocessor\t: 1\nmodel name\t: Made-up 9000\n");
  put("proc/sys/kernel/hostname", "bench\n");
  put("proc/sys/kernel/osrelease", "6.1.0-rt\n");
  put("sys/kernel/realtime", "1\n");
  put("sys/devices/system/cpu/isolated", "1\n");
  put("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance\n");
  DoctorSources sources;
  sources.root = root;
  sources.run = [](const std::string&) { return std::string(); };
  sources.cpu = 1;
  const MachineIdentity machine = identify_machine(sources, "loopback");
  std::filesystem::remove_all(root);
  EXPECT_EQ(machine.host, "bench");
  EXPECT_EQ(machine.cpu_model, "Made-up 9000");
  EXPECT_EQ(machine.cpus, 2);
  EXPECT_EQ(machine.microcode, "0x12");
  EXPECT_EQ(machine.kernel, "6.1.0-rt");
  EXPECT_TRUE(machine.realtime_kernel);
  EXPECT_EQ(machine.isolated_cpus, "1");
  EXPECT_EQ(machine.governor, "performance");
  EXPECT_FALSE(machine.checks.empty());
}

class CertifyRun : public testing::Test {
 protected:
  CertifyRun() {
    folder_ = std::filesystem::temp_directory_path() / ("palpate_certify_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    options_.out = (folder_ / "result").string();
    options_.priority = 0;  // works without privileges
    options_.program_folder =
        (std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "bin").string();
  }
  ~CertifyRun() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
  CertifyOptions options_;
};

TEST_F(CertifyRun, RunsTheRealLoopWithoutForceUnderLoad) {
  options_.duration_s = 2.5;
  options_.host_load = true;
  int calls = 0;
  options_.progress = [&](const LiveState& state) {
    calls += 1;
    EXPECT_EQ(state.duration_s, 2.5);
  };
  const auto certificate = std::make_unique<HostCertificate>(certify(options_));
  EXPECT_GT(certificate->run.summary.ticks, 0u);
  EXPECT_EQ(certificate->run.summary.device_force_max_N, 0.0);
  EXPECT_FALSE(certificate->run.interrupted);
  EXPECT_TRUE(certificate->run.summary.fault != 0 || certificate->run.summary.contact_force_max_N > 0)
      << "the hand must have pressed the ball: contact ticks are what takes time";
  EXPECT_GE(calls, 2);
  EXPECT_EQ(certificate->period_ns, 1'000'000);
  EXPECT_NE(certificate->verdict, CertifyVerdict::kIncomplete);
}

TEST_F(CertifyRun, InterruptKeepsWhatWasMeasured) {
  options_.duration_s = 600;
  std::thread interrupt;
  options_.progress = [&](const LiveState& state) {
    if (state.all->ticks > 100 && !interrupt.joinable()) interrupt = std::thread([] { kill(getpid(), SIGINT); });
  };
  const auto certificate = std::make_unique<HostCertificate>(certify(options_));
  if (interrupt.joinable()) interrupt.join();
  EXPECT_GT(certificate->run.summary.ticks, 100u);
  EXPECT_TRUE(certificate->run.interrupted || certificate->run.faulted());
  EXPECT_NE(certificate->verdict, CertifyVerdict::kPass);
}

}  // namespace
}  // namespace palpate
