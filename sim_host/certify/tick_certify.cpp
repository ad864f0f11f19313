#include "sim_host/certify/tick_certify.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include "config/bake/certificate_writer.h"
#include "rt_core/image.h"
#include "rt_core/stage_cost.h"
#include "rt_core/tick.h"
#include "sim_host/certify/page_watch.h"
#include "sim_host/press/press.h"
#include "sim_host/status_text.h"

namespace palpate {

namespace {

constexpr int kWarmRepeats = 200, kColdRepeats = 20;
// More than the second-level caches of any core; what is shared between cores may be larger.
constexpr std::size_t kEvictBytes = std::size_t{64} << 20;

// The inputs that a hand on the scene's own path makes.
std::vector<Input> inputs_along(const Model& model, std::span<const TimedPose> path, double hand_N_per_m) {
  std::vector<Input> inputs;
  if (path.empty()) return inputs;
  const StatePtr state = make_state(model);
  press(model, path, {hand_N_per_m}, *state, nullptr,
        [&](const PressRow& row, const State&, const Scratch&) { inputs.push_back(row.record.input); });
  return inputs;
}

// Image, State and Scratch on pages of their own, to be watched while the dearest tick runs.
void watch_memory(std::span<const std::byte> image, const DearTick& dear, TickCertificate& certificate) {
  const WatchedBlock bytes(image.size());
  std::memcpy(bytes.data(), image.data(), image.size());
  Model model;
  if (open_image({bytes.data(), image.size()}, model).error != ImageError::kNone)
    throw std::runtime_error("certify: the image does not open from a copy");
  const WatchedBlock state_block(state_bytes(model)), scratch_block(scratch_bytes(model));
  State& state = create_state(model, state_block.data());
  Scratch& scratch = create_scratch(model, scratch_block.data());
  copy_state(*dear.before, state);
  const std::array<const WatchedBlock*, 3> blocks = {&bytes, &state_block, &scratch_block};
  Output output;
  const std::vector<std::size_t> touched =
      bytes_touched(blocks, [&] { tick(model, state, scratch, dear.input, output); });
  certificate.image_bytes = static_cast<double>(touched[0]);
  certificate.state_bytes = static_cast<double>(touched[1]);
  certificate.scratch_bytes = static_cast<double>(touched[2]);
}

TickTimes time_tick(const Model& model, const DearTick& dear) {
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  std::vector<char> other(kEvictBytes, 1);
  Output output;
  const auto run = [&] {
    const auto begin = std::chrono::steady_clock::now();
    tick(model, *state, *scratch, dear.input, output);
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
  };
  TickTimes times{1e300, 1e300};
  for (int i = 0; i < kWarmRepeats; ++i) {
    copy_state(*dear.before, *state);
    times.warm_us = std::min(times.warm_us, run());
  }
  for (int i = 0; i < kColdRepeats; ++i) {
    copy_state(*dear.before, *state);
    for (std::size_t at = 0; at < other.size(); at += 64) other[at] = static_cast<char>(other[at] + 1);
    times.cold_us = std::min(times.cold_us, run());
  }
  return times;
}

}  // namespace

Certified certify_ticks(std::span<const std::byte> image, std::span<const TimedPose> path, double hand_N_per_m,
                        const TickSearchOptions& options) {
  Model model;
  if (open_image(image, model).error != ImageError::kNone) throw std::runtime_error("certify: the image does not open");
  Certified certified;
  certified.search = search_ticks(model, inputs_along(model, path, hand_N_per_m), options);
  TickCertificate& certificate = certified.certificate;
  std::copy(certified.search.stage.begin(), certified.search.stage.end(), certificate.stage_instructions);
  certificate.tick_instructions = certified.search.dearest.instructions;
  certificate.ticks = static_cast<double>(certified.search.ticks);
  watch_memory(image, certified.search.dearest, certificate);
  certified.times = time_tick(model, certified.search.dearest);
  return certified;
}

std::vector<std::byte> with_certificate(std::span<const std::byte> image, const TickCertificate& certificate) {
  const Certificate before = certificate_of(image);
  const std::vector<CheckedPlace> place(before.place.begin(), before.place.end());
  std::vector<std::byte> bytes(image.begin(), image.end());
  append_certificate(bytes, place, &certificate);
  return bytes;
}

std::string certified_text(const Model& model, const Certified& certified) {
  const TickCertificate& c = certified.certificate;
  std::string text = fmt::format("{:<12}{:>12}{:>12}\n", "stage", "found", "stated");
  const auto out = std::back_inserter(text);
  for (std::int32_t i = 0; i < kStageCount; ++i)
    fmt::format_to(out, "{:<12}{:>12.0f}{:>12.0f}\n", stage_name(static_cast<Stage>(i)), c.stage_instructions[i],
                   model.stage_cost[static_cast<std::size_t>(i)].instructions);
  fmt::format_to(out, "{:<12}{:>12.0f}{:>12.0f}  instructions by the work it counts, in one tick\n", "tick",
                 c.tick_instructions, worst_tick_instructions(model));
  fmt::format_to(out, "found by    {}, in {} ticks\n", certified.search.found_by, certified.search.ticks);
  fmt::format_to(out, "touched     {} KiB of the image, {} KiB of State, {} KiB of Scratch, in pages\n",
                 c.image_bytes / 1024, c.state_bytes / 1024, c.scratch_bytes / 1024);
  fmt::format_to(out, "time        {:.1f} us warm, {:.1f} us with cold caches; here, the least of {} and {}\n",
                 certified.times.warm_us, certified.times.cold_us, kWarmRepeats, kColdRepeats);
  return text;
}

}  // namespace palpate
