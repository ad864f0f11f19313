#include "sim_host/record/black_box.h"

#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <utility>

#include "rt_core/tick.h"
#include "sim_host/status_text.h"

namespace palpate {

BlackBox::BlackBox(std::string prefix, const RecordingHeader& header, const State& initial_state, const Model* model,
                   CandumpOptions candump, std::vector<PackedPiece> image)
    : prefix_(std::move(prefix)),
      header_(header),
      candump_(std::move(candump)),
      model_(model),
      image_(std::move(image)),
      ring_(kBlackBoxTicks),
      state_(copy_of(initial_state)),
      scratch_(model == nullptr ? ScratchPtr() : make_scratch(*model)) {}

// Moves the kept state over the oldest record, then forgets that record.
void BlackBox::drop_oldest() {
  const TickRecord& oldest = at(0);
  state_known_ = state_known_ && model_ != nullptr && oldest.sequence == state_sequence_;
  if (state_known_) {
    Output output;
    tick(*model_, *state_, *scratch_, oldest.input, output);
    state_known_ = hash_state(*state_) == oldest.state_hash;
    state_sequence_ += 1;
  }
  first_ = (first_ + 1) % kBlackBoxTicks;
  count_ -= 1;
}

void BlackBox::add(const TickRecord& record) {
  if (count_ == kBlackBoxTicks) drop_oldest();
  ring_[(first_ + count_) % kBlackBoxTicks] = record;
  count_ += 1;
  const std::uint32_t latched = record.output.fault & ~last_fault_;
  last_fault_ = record.output.fault;
  if (cause_.empty()) {
    if (latched == 0) return;
    cause_ = bit_names(fault_bit_texts(), latched);
    cause_sequence_ = record.sequence;
    ticks_after_ = 0;
  } else {  // faults that latch while one waits to be written belong to it
    if (latched != 0) cause_ += " then " + bit_names(fault_bit_texts(), latched);
    if (++ticks_after_ >= kBlackBoxTicksAfter) dump();
  }
}

void BlackBox::finish(const std::string& death) {
  if (!death.empty()) {
    cause_ += (cause_.empty() ? "" : " then ") + death;
    if (count_ > 0) cause_sequence_ = at(count_ - 1).sequence;
  }
  if (!cause_.empty()) dump();
}

void BlackBox::dump() {
  BlackBoxDump dump;
  dump.cause = std::exchange(cause_, {});
  faults_ += 1;
  if (dumps_.size() >= kBlackBoxMostDumps || count_ == 0) return;
  // Never over the black box of an earlier run.
  const auto name = [this] { return fmt::format("{}.fault-{}.plr", prefix_, number_); };
  while (free_name(name()) != name()) number_ += 1;  // bound: files in the folder
  const std::string base = fmt::format("{}.fault-{}", prefix_, number_);
  dump.recording = base + ".plr";
  dump.log = base + ".log";
  dump.sequence = cause_sequence_;
  dump.ticks = count_;
  dump.replayable = state_known_ && at(0).sequence == state_sequence_;
  try {
    write_recording(dump);
    write_log(dump);
    dumps_.push_back(std::move(dump));
  } catch (const std::runtime_error& error) {
    error_ = error.what();
  }
}

void BlackBox::write_recording(const BlackBoxDump& dump) {
  RecordingWriter file(PartFile(dump.recording, WhenItExists::kRefuse), header_, block_of(*state_), image_);
  file.begin_slice(at(0).sequence, dump.replayable);
  for (std::size_t i = 0; i < count_; ++i) {
    const std::uint64_t expected = i == 0 ? at(0).sequence : at(i - 1).sequence + 1;
    if (at(i).sequence > expected) file.add_lost(expected, at(i).sequence - expected);
    file.add(at(i));
  }
  file.finish();
}

void BlackBox::write_log(const BlackBoxDump& dump) const {
  std::ofstream file(dump.log, std::ios::binary);
  CandumpLog log(candump_);
  std::string text;
  for (std::size_t i = 0; i < count_; ++i) log.add(at(i), text);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(dump.log + ": cannot write");
}

std::int64_t wall_minus_monotonic_ns() {
  const auto now_ns = [](clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
  };
  return now_ns(CLOCK_REALTIME) - now_ns(CLOCK_MONOTONIC);
}

}  // namespace palpate
