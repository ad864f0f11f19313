// lab_check IMAGE RECORDING none|FAULT: what docs/faults.md promises, of a recorded run. No force above the device's
// limit, no step between two ticks above the rate limit; and either no fault, or exactly this one, latched in the very
// tick that had its cause, with zero force from the end of the ramp on.
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>

#include "sim_host/bake/image_file.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/status_text.h"

namespace palpate {
namespace {

struct Found {
  std::uint64_t ticks = 0, latched = 0, zero_again = 0;  // tick numbers from 1; zero_again: last one with force, + 1
  double force_N = 0, step_N = 0;
  std::uint32_t faults = 0;
  bool caused = false;  // the latching tick had the cause in its input
};

Found read(const std::string& path, const ModelParams& limits, std::string& wrong) {
  const MappedFile file(path);
  RecordingReader recording(file.bytes());
  Found found;
  TickRecord record;
  Vec3 before_N;
  while (recording.next(record)) {
    found.ticks += 1;
    const Vec3 force_N = record.output.device_w.force_N;
    found.force_N = max_of(found.force_N, norm(force_N));
    found.step_N = max_of(found.step_N, norm(force_N - before_N));
    before_N = force_N;
    if (record.output.fault != 0 && found.faults == 0) {
      found.latched = found.ticks;
      // Samples that cannot be true count as none; for both, silence has lasted no longer than its limit.
      const bool rejected = (record.output.status & Status::kInputRejected) != 0;
      found.caused = (rejected || record.input.device_fault == record.output.fault) &&
                     static_cast<int>(record.input.stale_ticks) <= limits.silence_fault_ticks;
    }
    found.faults |= record.output.fault;
    if (record.output.device_w != Wrench{}) found.zero_again = found.ticks + 1;
  }
  if (!recording.error().empty()) wrong = recording.error();
  if (recording.lost() > 0) wrong = fmt::format("{} records lost", recording.lost());
  return found;
}

std::string judge(const Found& found, const ModelParams& limits, const std::string& expected) {
  const double step_N =
      std::min(limits.force_rate_max_N_per_s * limits.period_s, kOutputStepShare * limits.force_max_N);
  const auto ramp = static_cast<std::uint64_t>(limits.ramp_out_s / limits.period_s + 0.5);
  const std::string name = found.faults == 0 ? "none" : bit_names(fault_bit_texts(), found.faults);
  constexpr double kFelt_N = 0.5;  // a run whose hand felt nothing proves nothing
  if (name != expected) return "ended with " + name + ", not " + expected;
  if (!(found.force_N > kFelt_N)) return fmt::format("the hand felt only {:.3f} N", found.force_N);
  if (!(found.force_N <= limits.force_max_N * (1 + 1e-12))) return fmt::format("{:.3f} N rendered", found.force_N);
  if (!(found.step_N <= step_N * (1 + 1e-9))) return fmt::format("a force step of {:.3f} N", found.step_N);
  if (found.faults == 0) return "";
  if (!found.caused) return fmt::format("latched at tick {} without its cause", found.latched);
  if (found.zero_again > found.latched + ramp) return fmt::format("force until tick {}", found.zero_again - 1);
  return "";
}

int run(char** argument) {
  const ImageFile image(argument[1]);
  const ModelParams& limits = image.model().params;
  std::string wrong;
  const Found found = read(argument[2], limits, wrong);
  if (wrong.empty()) wrong = judge(found, limits, argument[3]);
  std::printf("%s %llu ticks, at most %.3f N, largest step %.4f N (allowed %.1f)",
              wrong.empty() ? "kept:" : "BROKEN:", static_cast<unsigned long long>(found.ticks), found.force_N,
              found.step_N,
              std::min(limits.force_rate_max_N_per_s * limits.period_s, kOutputStepShare * limits.force_max_N));
  if (found.faults != 0) {
    const std::uint64_t after = found.zero_again > found.latched ? found.zero_again - found.latched : 0;
    std::printf(", %s latched at tick %llu, zero force %llu ticks later", argument[3],
                static_cast<unsigned long long>(found.latched), static_cast<unsigned long long>(after));
  }
  std::printf("%s%s\n", wrong.empty() ? "" : ": ", wrong.c_str());
  return wrong.empty() ? 0 : 1;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("lab_check IMAGE RECORDING none|FAULT\n", stderr), 2;
  try {
    return palpate::run(argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lab_check: %s\n", error.what());
    return 3;
  }
}
