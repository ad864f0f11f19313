// Re-runs tick() over the inputs of a recording and compares every tick with what was recorded.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "rt_core/model.h"
#include "rt_core/state.h"
#include "sim_host/record/recording_reader.h"

namespace palpate {

struct ReplayResult {
  std::uint64_t ticks = 0;         // verified identical, from the start on
  std::uint64_t lost = 0;          // records missing in the recording: nothing after the first gap can be verified
  bool differs = false;            // the fields below say where
  std::uint64_t tick = 0;          // first tick that differs (State::tick before it)
  std::string stage;               // first stage whose results differ
  std::string field;               // first field of that stage
  std::string recorded, replayed;  // its values as text
  std::string damage;              // not empty: the recording is damaged or cut there
  bool identical() const { return !differs && lost == 0 && damage.empty(); }
};

// Called with every recorded tick and what the replay made of it.
using ReplayListener = std::function<void(const TickRecord& recorded, const TickRecord& replayed)>;

// Replays until the first difference, gap or damage. Throws RecordingError, naming both hashes, when the recording was
// made with another scene image.
ReplayResult replay(RecordingReader& recording, const Model& model, const ReplayListener& listen = {});

// Called with every recorded tick and the state after it; false ends it.
using StateListener = std::function<bool(const TickRecord& recorded, const State& state)>;
// Runs the inputs of a recording again, tick after tick. Returns the state at which `listen` ended it; null at the end
// of the recording. Throws RecordingError when the image is another one, or a tick is missing.
StatePtr for_each_state(RecordingReader& recording, const Model& model, const StateListener& listen);

// The state after the recorded tick `wanted`, by running the inputs up to it again. Throws RecordingError when the
// image is another one, or a tick before it is missing.
StatePtr state_after(RecordingReader& recording, const Model& model, std::uint64_t wanted);

// First field in which two records of one tick differ, in the order of the stages; false when all agree.
bool first_record_difference(const TickRecord& recorded, const TickRecord& replayed, ReplayResult& result);

}  // namespace palpate
