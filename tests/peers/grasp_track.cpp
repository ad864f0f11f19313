#include "tests/peers/grasp_track.h"

#include <algorithm>
#include <chrono>

#include "rt_core/tick.h"
#include "rt_core/tool/articulate.h"
#include "sim_host/tick_memory.h"
#include "tests/support/scripted_hand.h"

namespace palpate::peers {

Track play(const Model& model, int passes) {
  Track track;
  track.period_s = model.params.period_s;
  track.tick.resize(test::kScriptTicks);
  const auto state = make_state(model);
  const auto scratch = make_scratch(model);
  for (int pass = 0; pass < passes; ++pass) {
    reset(*state);
    Output output;
    test::ScriptedHand hand(model);
    for (TrackTick& at : track.tick) {
      const Input input = hand.next(output);
      const auto begin = std::chrono::steady_clock::now();
      tick(model, *state, *scratch, input, output);
      const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
      at.tick_us = std::min(at.tick_us, took.count());
      at.contacts = output.contacts;
      at.piece_w.clear();
      for (std::int32_t i = 0; i < static_cast<std::int32_t>(model.piece.size()); ++i)
        at.piece_w.push_back(carrier_w(model, *state, i) * model.piece[static_cast<std::size_t>(i)].pose_tool);
    }
  }
  return track;
}

}  // namespace palpate::peers
