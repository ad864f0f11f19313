// lab_flood IMAGE DEVICE SECONDS: starts the controller as `palpate run` does and then writes its command region as
// fast as it can, with every command but stop. The controller must not be late for it.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "rt_core/io.h"
#include "sim_host/controller_link.h"
#include "sim_host/recorder.h"
#include "sim_host/run_summary.h"

namespace palpate {
namespace {

int flood(const std::string& image, const std::string& device, double seconds) {
  ControllerLink link(sibling_program("palpate-rt"), {"--image", image, "--device", device, "--priority", "80"}, -1);
  RunSummary summary;
  Recorder recorder(link.telemetry(), nullptr, [&](const TickRecord& record) { add(summary, record); });
  recorder.start();
  std::uint64_t written = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end) {
    link.mailbox().set(written % 2 == 0 ? Command::kArm : Command::kReset, false);
    link.mailbox().beat();
    written += 2;
  }
  const int exit_code = link.finish();
  recorder.stop();
  std::printf("flooded with %llu commands\n%s", static_cast<unsigned long long>(written),
              summary_text(summary, recorder.lost()).c_str());
  return exit_code;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("lab_flood IMAGE DEVICE SECONDS\n", stderr), 2;
  try {
    return palpate::flood(argv[1], argv[2], std::atof(argv[3]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lab_flood: %s\n", error.what());
    return 3;
  }
}
