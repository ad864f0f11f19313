// lab_host IMAGE DEVICE PROFILE SECONDS FLOOD_MS RESULTS: a host as bad as it can be. It starts the controller as
// `palpate run` does, and for FLOOD_MS out of every 4 s writes the command region as fast as it can, with every command
// but stop; in between it shows that it lives and asks for force. It reads every tick all the time, leaves the
// histograms in RESULTS, prints the summary, and dies without a word to the controller. The controller must not be late
// for any of it.
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "config/scene/child_program.h"
#include "rt_core/io.h"
#include "sim_host/latency/cyclictest_read.h"
#include "sim_host/latency/latency.h"
#include "sim_host/record/recorder.h"
#include "sim_host/run/controller_link.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kCycle{4000}, kHeartbeat{50};
constexpr std::uint64_t kBurst = 1000;  // commands between two looks at the clock

// Every other command arms: an edge each time, taken only when the controller is idle.
std::uint64_t flood(MailboxWriter& mailbox, Clock::time_point until) {
  std::uint64_t written = 0;
  while (Clock::now() < until) {
    for (std::uint64_t i = 0; i < kBurst; ++i) {
      mailbox.set(i % 2 == 0 ? Command::kArm : Command::kReset, false);
      mailbox.beat();
    }
    written += 2 * kBurst;
  }
  return written;
}

void write_histograms(const LatencyData& data, const std::string& folder) {
  std::ofstream(folder + "/latency.txt") << cyclictest_text({data.wake});
  const CyclictestHistogram kernel = read_cyclictest(folder + "/cyclictest.txt");
  const LatencySeries overlay[] = {{"cyclictest", &kernel.latency}};
  const CyclictestRun system = this_system();
  latency_drawing(data, fmt::format("{} ticks, {} {}", data.summary.ticks, system.sysname, system.release), overlay)
      .save(folder + "/latency.svg");
}

[[noreturn]] void run(char** argument) {
  ControllerLink link(sibling_program("palpate-rt"),
                      {"--image", argument[1], "--device", argument[2], "--profile", argument[3], "--priority", "80"},
                      -1);
  const auto data = std::make_unique<LatencyData>();
  Recorder recorder(link.telemetry(), nullptr, [&](const TickRecord& record) { add(*data, record); });
  recorder.start();
  const auto end = Clock::now() + std::chrono::duration<double>(std::atof(argument[4]));
  const milliseconds flooding{std::atoi(argument[5])};
  std::uint64_t written = 0;
  bool arming = false;
  for (auto start = Clock::now(); start < end; start += kCycle) {
    written += flood(link.mailbox(), start + flooding);
    while (Clock::now() <
           std::min<Clock::time_point>(start + kCycle, std::chrono::time_point_cast<Clock::duration>(end))) {
      arming = !arming;  // arming is an edge, and one offered to a tick without a sample is lost
      link.mailbox().set(arming ? Command::kArm : 0, false);
      link.mailbox().beat();
      std::this_thread::sleep_for(kHeartbeat);
    }
  }
  recorder.stop();
  write_histograms(*data, argument[6]);
  std::printf("flooded with %llu commands\n%s", static_cast<unsigned long long>(written),
              summary_text(data->summary, recorder.lost(), 10).c_str());
  std::fflush(nullptr);
  ::kill(::getpid(), SIGKILL);
  std::abort();
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  if (argc != 7) return std::fputs("lab_host IMAGE DEVICE PROFILE SECONDS FLOOD_MS RESULTS\n", stderr), 2;
  try {
    palpate::run(argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lab_host: %s\n", error.what());
    return 3;
  }
}
