// The black box: the last seconds of a run in fixed memory, written out with every fault and when the controller dies:
//   PREFIX.fault-N.plr  a slice of the run, which `palpate replay` verifies
//   PREFIX.fault-N.log  its frames in the format of `candump -L`, re-encoded (see candump_log.h)
//
// A slice can be replayed only from the state before its first tick, which no record holds. The box therefore runs
// every record that leaves it through tick() and so keeps the state before the oldest one it holds (measured
// 2026-11-21: 3 µs a tick for ellipsoid_mallet, on an ordinary thread). The state's hash is compared with the
// recorded one; once it differs, or records were lost, later slices say that they can only be listed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"
#include "sim_host/record/candump_log.h"
#include "sim_host/record/recording_writer.h"
#include "sim_host/tick_memory.h"

namespace palpate {

// Ticks held: 4 s at 1 kHz, as much as the telemetry ring.
inline constexpr std::size_t kBlackBoxTicks = 4096;
// Ticks waited for after a fault latched, so that the ramp to zero is in the slice.
inline constexpr std::uint32_t kBlackBoxTicksAfter = 200;
// Faults written out in one run; more of them are counted only, so that a flapping fault cannot fill the disk.
inline constexpr std::size_t kBlackBoxMostDumps = 16;

struct BlackBoxDump {
  std::string recording, log;  // paths
  std::string cause;           // names of the fault bits, or how the controller ended
  std::uint64_t sequence = 0;  // of the record with which the fault latched; the last one when the controller died
  std::uint64_t ticks = 0;
  bool replayable = false;
};

class BlackBox {
 public:
  // `model` may be null: then only slices that begin with the run can be replayed. It must outlive this. `image`: goes
  // into every slice, so that it can be replayed without the scene.
  BlackBox(std::string prefix, const RecordingHeader& header, const State& initial_state, const Model* model,
           CandumpOptions candump, std::vector<PackedPiece> image = {});

  // Before the first record, which is not the run's: `first` is its sequence. `known`: it is the initial state's tick.
  void begin_at(std::uint64_t first, bool known) {
    state_sequence_ = first;
    state_known_ = known;
  }
  // Every record of the run in order, from one thread.
  void add(const TickRecord& record);
  // At the end of the run. `death`: not empty when the controller ended other than in order, and how.
  void finish(const std::string& death);

  const std::vector<BlackBoxDump>& dumps() const { return dumps_; }
  std::uint64_t faults() const { return faults_; }
  // Empty, or why a file could not be written.
  const std::string& error() const { return error_; }

 private:
  void drop_oldest();
  void dump();
  void write_recording(const BlackBoxDump& dump);
  void write_log(const BlackBoxDump& dump) const;
  const TickRecord& at(std::size_t i) const { return ring_[(first_ + i) % kBlackBoxTicks]; }

  std::string prefix_;
  RecordingHeader header_;
  CandumpOptions candump_;
  const Model* model_;
  std::vector<PackedPiece> image_;
  std::vector<TickRecord> ring_;
  std::size_t first_ = 0, count_ = 0;
  StatePtr state_;  // before the record state_sequence_, if state_known_
  ScratchPtr scratch_;
  std::uint64_t state_sequence_ = 1;
  bool state_known_ = true;
  std::uint32_t last_fault_ = 0;
  std::string cause_;  // of the dump that waits for the ticks after it
  std::uint64_t cause_sequence_ = 0;
  std::uint32_t ticks_after_ = 0;
  std::uint64_t faults_ = 0;
  std::size_t number_ = 1;  // in the name of the next dump
  std::vector<BlackBoxDump> dumps_;
  std::string error_;
};

// CLOCK_REALTIME minus CLOCK_MONOTONIC now.
std::int64_t wall_minus_monotonic_ns();

}  // namespace palpate
