// A run that goes on goes over to another scene, as its viewer asks: the scene is baked on a thread of its own, the
// controller is asked as `palpate switch` asks it, and it is told in words how far that is, or why it is refused.
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "config/scene/child_program.h"
#include "sim_host/bake/image_file.h"
#include "sim_host/tick_memory.h"
#include "sim_host/view/run_track.h"
#include "sim_host/view/scene_choice.h"

namespace palpate {

// One scene of a run: its image, and its ticks so far.
struct LiveScene {
  // Throws std::runtime_error when the image cannot be read.
  LiveScene(SceneChoice choice, const std::string& image_path);
  SceneChoice choice;
  ImageFile image;
  std::string title;
  RunTrack track;
  StatePtr initial;  // before the first tick
};

class SceneChange {
 public:
  enum class Stage {
    kNone,     // nobody asked yet
    kBaking,   // or read and checked here
    kAsking,   // the controller reads and checks it
    kGoing,    // force ramps to zero
    kThere,    // the new scene's first tick came
    kRefused,  // the run goes on as it was
  };
  struct News {
    Stage stage = Stage::kNone;
    std::string title;  // of the scene that was asked for
    std::string words;  // what is done about it, or why not
    double since_s = 0;
    bool going_on() const { return stage == Stage::kBaking || stage == Stage::kAsking || stage == Stage::kGoing; }
  };

  // `first`: what the run began with, baked to `image`.
  SceneChange(SceneChoice first, const std::string& image) : now_(std::move(first)), baked_{{now_.key(), image}} {}
  // Ends a bake that is under way, at its next word of progress.
  ~SceneChange();
  SceneChange(const SceneChange&) = delete;
  SceneChange& operator=(const SceneChange&) = delete;

  // By the viewer. False: another change is under way.
  bool ask(const SceneChoice& choice);
  News news() const;
  SceneChoice now() const;  // what the run is in

  // By the run. Path of the image the controller is to be asked for, once; "" otherwise.
  std::string image_wanted();
  void refused(const std::string& wrong);
  // The run will go over to this image, which may have been asked for elsewhere (`palpate switch`): what it is.
  std::shared_ptr<LiveScene> accepted(const std::string& image);
  // The next accepted scene's first tick came; null when there is none.
  std::shared_ptr<LiveScene> arrived();

 private:
  void prepare(SceneChoice choice);
  std::string image_of(const SceneChoice& choice);
  void say(Stage stage, const std::string& words);

  const TemporaryFolder folder_{"palpate-view-scenes"};
  mutable std::mutex mutex_;
  SceneChoice now_;
  News news_;
  std::chrono::steady_clock::time_point since_;
  std::map<std::string, std::string> baked_;  // images by the keys of their choices
  int images_ = 0;                            // as baked_, of the baking thread alone
  std::shared_ptr<LiveScene> asked_;          // what was asked for here, not accepted yet
  std::string asked_image_, image_;           // its image; and while it is to be announced
  std::shared_ptr<LiveScene> own_;            // accepted, of those the one that was asked for here
  std::deque<std::shared_ptr<LiveScene>> accepted_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace palpate
