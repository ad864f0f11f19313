// The viewer's window: draws a run, recorded or going on, until it is closed.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "sim_host/view/orbit_camera.h"
#include "sim_host/view/run_track.h"
#include "sim_host/view/steering.h"

namespace palpate {

struct ViewerOptions {
  int width = 1600, height = 1000;
  std::string title;
  std::string screenshot;      // write this PNG of one tick and leave; no window is shown
  std::optional<double> at_s;  // start there; default: at the largest force, of a live run at its end
  StandardView view = StandardView::kOblique;
  bool default_view = true;             // the still pictures' view, from the side of the contacts
  bool panel = true;                    // plots and words at the right
  bool stats = false;                   // print frame times and memory at the end
  double stats_s = 5;                   // after so long, when stats are asked for
  std::size_t most_triangles = 60'000;  // bodies are refined for drawing up to this
};

// A run to look at. What is empty is not so.
struct ViewerRun {
  const Model* model = nullptr;
  const RunTrack* track = nullptr;
  const State* initial = nullptr;       // before the track's first tick
  std::function<bool()> goes_on;        // of a live run
  std::function<bool()> closes;         // the window is to close: Ctrl-C ended the run
  std::function<std::string()> notice;  // what to tell the person, or ""
  Steering* steering = nullptr;         // of a run whose device is the mouse
  bool live() const { return goes_on && goes_on(); }
  bool can_steer() const { return steering != nullptr; }
};

// Returns when the window is closed, the screenshot is written, or SIGINT came. Throws std::runtime_error when there is
// no display or no OpenGL 3.3, saying what to do.
void show_run(const ViewerRun& run, const ViewerOptions& options);

}  // namespace palpate
