// What the host keeps of the scenes of a run, each by itself: a recording, a black box, whether a hand held its body. A
// run that goes over to another scene closes the recording and begins a new one, NAME.scene-2.plr: a recording has one
// scene and one initial state, so that it replays as every other.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "sim_host/bake/image_file.h"
#include "sim_host/press/grasp_watch.h"
#include "sim_host/record/black_box.h"
#include "sim_host/record/part_file.h"
#include "sim_host/record/recording_writer.h"
#include "sim_host/tick_memory.h"

namespace palpate {

// Where a run's files are, and how they are written.
struct SceneLogOptions {
  std::string record;  // of the first scene; empty: none
  WhenItExists exists = WhenItExists::kRefuse;
  std::string black_box;  // prefix; empty: none
  CandumpOptions candump;
};

class SceneLog {
 public:
  // `file`: the first scene's recording, or none. `header`: of the run. `image`: must live as long.
  SceneLog(const SceneLogOptions& options, const RecordingHeader& header, const ImageFile& image,
           std::optional<PartFile> file);
  // By the host: the run will go over to the scene of this image, whose checksum the controller read. Throws
  // std::runtime_error when it has changed since, or its files cannot be begun.
  void expect(const std::string& path, std::uint64_t scene_hash);
  // By the recorder, from here on. The recording of the scene that ticks are of now; may be null.
  RecordingWriter* file() { return now().file.get(); }
  // The next scene that was expected begins with record `first`; `whole`: that is its very first tick.
  RecordingWriter* turn(std::uint64_t first, bool whole);
  void add(const TickRecord& record);
  // Once the run is over. `death`: how the controller died, or "".
  void finish(const std::string& death);

  std::vector<BlackBoxDump> dumps() const;
  std::string black_box_error() const;
  std::string grasp() const;
  std::vector<std::string> later_recordings() const;

 private:
  struct Kept {
    std::unique_ptr<ImageFile> image;  // of a later scene
    StatePtr initial;                  // every scene begins after a reset
    std::unique_ptr<RecordingWriter> file;
    std::unique_ptr<BlackBox> box;
    std::unique_ptr<GraspWatch> grasp;
  };
  Kept& now() { return *scene_.back(); }
  std::unique_ptr<Kept> begin(const ImageFile& image, std::optional<PartFile> file);

  SceneLogOptions options_;
  RecordingHeader header_;
  std::vector<std::unique_ptr<Kept>> scene_;
  std::mutex mutex_;  // of what follows: expected by the host, taken by the recorder
  std::deque<std::unique_ptr<Kept>> expected_;
  std::size_t begun_ = 0;
};

}  // namespace palpate
