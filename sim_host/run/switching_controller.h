// rt_core's tick for a run that may go over to another scene (scene_shelf.h). While another is wanted, force ramps to
// zero as it does on a stop; at rest, with a fresh sample, the tick is the other scene's first. Nothing of the old
// scene goes on: contact memory, mode and gain are as after a reset, and force comes back only when it is armed anew,
// by an edge that came after. A latched fault is no rest: it stays, and so does the scene.
//
// A record tells where a scene began: its tick counts from 0 again, so that sequence minus tick is constant in a scene.
#pragma once

#include "rt_core/record.h"
#include "rt_core/tick.h"
#include "sim_host/run/host_port.h"
#include "sim_host/run/scene_shelf.h"

namespace palpate {

class SwitchingController {
 public:
  // `telemetry`: told of the scenes; may be null.
  SwitchingController(const Model& model, State& state, Scratch& scratch, const SceneShelf& shelf, const HostPort& host,
                      TelemetryWriter* telemetry) noexcept
      : model_(&model), state_(&state), scratch_(&scratch), shelf_(shelf), host_(host), telemetry_(telemetry) {}

  void step(const Input& input, Output& output, const StageProbe& probe) PALPATE_RT {
    seen_ = input;
    if (ShelvedScene* next = host_.scene() > number_ ? shelf_.at(host_.scene()) : nullptr; next != nullptr) {
      if (at_rest_ && input.stale_ticks == 0) {
        take_up(*next);
      } else {
        seen_.commands |= Command::kStop;
      }
    }
    // Arming is an edge: one that was meant for the scene before does not count.
    if ((input.commands & Command::kArm) == 0) released_ = true;
    if (!released_) seen_.commands &= ~Command::kArm;
    tick(*model_, *state_, *scratch_, seen_, output, probe);
    at_rest_ = output.mode == Mode::kIdle && output.device_w == Wrench{} && output.second_w == Wrench{};
  }
  void fill(const Input&, const Output& output, TickRecord& record) PALPATE_RT {
    fill_record(*state_, seen_, output, record);
  }
  // Which scene it is in: 0 until the first change. Once the loop has ended, from any thread.
  std::uint64_t number() const { return number_; }

 private:
  void take_up(ShelvedScene& next) PALPATE_RT {
    model_ = &next.model;
    state_ = next.state.get();
    scratch_ = next.scratch.get();
    number_ = host_.scene();
    released_ = false;
    if (telemetry_ != nullptr) telemetry_->begin_scene(number_);
  }

  const Model* model_;
  State* state_;
  Scratch* scratch_;
  const SceneShelf& shelf_;
  const HostPort& host_;
  TelemetryWriter* telemetry_;
  Input seen_;  // what the tick saw, which is what is recorded
  std::uint64_t number_ = 0;
  bool at_rest_ = true;
  bool released_ = true;
};

}  // namespace palpate
