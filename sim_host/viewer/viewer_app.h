// The viewer's window: draws a run, recorded or going on, until it is closed.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "sim_host/view/comparison.h"
#include "sim_host/view/orbit_camera.h"
#include "sim_host/view/scene_change.h"
#include "sim_host/view/steering.h"
#include "sim_host/view/view_scales.h"
#include "sim_host/view/view_script.h"

namespace palpate {

struct ViewerOptions {
  int width = 1600, height = 1000;
  std::string screenshot;        // write this PNG of one tick and leave; no window is shown
  std::vector<ViewStep> script;  // done instead of a person; then it leaves
  std::optional<double> at_s;    // start there; default: at the largest force, of a live run at its end
  StandardView view = StandardView::kOblique;
  bool default_view = true;  // the still pictures' view, from the side of the contacts
  SurfaceColour colour = SurfaceColour::kDisplacement;
  bool panel = true;                    // plots and words at the right
  bool stats = false;                   // print frame times and memory at the end
  double stats_s = 5;                   // after so long, when stats are asked for
  std::size_t most_triangles = 60'000;  // bodies are refined for drawing up to this
};

// A run to look at. What is empty is not so.
struct ViewerRun {
  std::string title;
  const Model* model = nullptr;
  const RunTrack* track = nullptr;
  const State* initial = nullptr;       // before the track's first tick
  std::function<bool()> goes_on;        // of a live run
  std::function<bool()> closes;         // the window is to close: Ctrl-C ended the run
  std::function<std::string()> notice;  // what to tell the person, or ""
  Steering* steering = nullptr;         // of a run whose device is the mouse
  SceneChange* change = nullptr;        // of a run that can go over to other scenes
  std::vector<std::string> also;        // files to offer there, besides those of the scene's folder
  // Of such a run: the scene it is in now, of which title, model, track and the state at first are.
  std::function<std::shared_ptr<const LiveScene>()> newest;
  std::shared_ptr<const LiveScene> scene;  // is held while it is shown
  bool live() const { return goes_on && goes_on(); }
  bool can_steer() const { return steering != nullptr; }
  void show(std::shared_ptr<const LiveScene> now) {
    model = &now->image.model();
    track = &now->track;
    initial = now->initial.get();
    title = now->title;
    scene = std::move(now);
  }
};

// Returns when the window is closed, the screenshot is written, or SIGINT came. Throws std::runtime_error when there is
// no display or no OpenGL 3.3, saying what to do.
void show_run(const ViewerRun& run, const ViewerOptions& options);
// Two recordings beside one another, with one camera, one scale and one time; `runs` in the order of `comparison`.
void show_comparison(const std::array<ViewerRun, Comparison::kRuns>& runs, const Comparison& comparison,
                     const ViewerOptions& options);

}  // namespace palpate
