// Scenes that a running controller may go over to. An ordinary thread reads, checks and lays out each; from then on
// nothing of it changes, and the loop takes it up by its number. All stay until the controller ends: the loop never
// frees, and nobody frees what it may be in.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "hal/system/private_file.h"
#include "rt_core/model.h"
#include "sim_host/rings/telemetry.h"
#include "sim_host/tick_memory.h"

namespace palpate {

// What host and controller say to each other about a scene, on the socket they were set up with: this and the path of
// an image there; one of these two back, and after the second why not.
inline constexpr char kAnnounce = 'S', kReady = '+', kRefuses = '-';

struct ShelvedScene {
  PrivateFile image;
  Model model;
  StatePtr state;  // as after a reset
  ScratchPtr scratch;
};

// Why a run cannot go over from one scene to the other: device, limits and period must be those that everything around
// the tick was set up for. "" when it can.
std::string scene_misfit(const ModelParams& now, const ModelParams& next);

class SceneShelf {
 public:
  // `first`: of the scene the run began with. `refuse`: what else speaks against a scene, or "".
  SceneShelf(const Model& first, std::function<std::string(const Model&)> refuse)
      : first_(first), refuse_(std::move(refuse)) {}

  // Reads, checks and lays out `path` as the next: "" when the loop can take it up, otherwise why not. `before`: called
  // with its number when nothing speaks against it, before the loop can.
  using Before = std::function<void(std::uint64_t number, const Model& next)>;
  std::string add(const std::string& path, const Before& before = {});
  std::uint64_t count() const PALPATE_RT { return count_.load(std::memory_order_acquire); }
  // By number, the first of the shelf being 1 (0 is what the run began with); null when there is none.
  ShelvedScene* at(std::uint64_t number) const PALPATE_RT {
    // Acquire: pairs with the release in add().
    return number >= 1 && number <= count_.load(std::memory_order_acquire) ? scene_[number - 1].get() : nullptr;
  }

 private:
  const Model& first_;
  std::function<std::string(const Model&)> refuse_;
  std::array<std::unique_ptr<ShelvedScene>, kMostLaterScenes> scene_;
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace palpate
