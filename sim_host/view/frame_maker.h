// Computes what a viewer shows of a tick, state and deformed surface, on a thread of its own: the picture keeps turning
// smoothly however long a surface takes.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "sim_host/view/deformed_surface.h"
#include "sim_host/view/run_track.h"
#include "sim_host/view/view_scales.h"

namespace palpate {

// A refined body as a graphics card takes it: corners that share place and normal are one vertex.
struct DrawnBody {
  struct Source {
    std::int32_t vertex, triangle, corner;  // of the DeformedSurface; `corner` of the triangle has the normal
  };
  std::vector<Source> source;
  std::vector<std::array<std::uint32_t, 3>> triangle;
};
DrawnBody drawn_body(const DeformedSurface& surface);

// Position (m), normal, displacement (m) and pressure (Pa) of one vertex, interleaved.
struct DrawnVertex {
  float position[3], normal[3], displacement_m, pressure_Pa;
};
std::vector<DrawnVertex> drawn_vertices(const DrawnBody& body, const DeformedSurface& surface);

struct ViewFrame {
  std::size_t index = 0;  // of the tick in the track
  StatePtr state;
  std::vector<DrawnVertex> vertex;
  std::array<double, 3> largest{};  // by SurfaceColour
  double made_ms = 0;               // time to compute it
};

class FrameMaker {
 public:
  // `initial`: the state before the track's first tick. Model and track must outlive this.
  FrameMaker(const Model& model, const RunTrack& track, StatePtr initial, std::size_t most_triangles);
  ~FrameMaker();
  FrameMaker(const FrameMaker&) = delete;
  FrameMaker& operator=(const FrameMaker&) = delete;

  const DrawnBody& body() const { return drawn_; }
  // The body before the run.
  const std::vector<DrawnVertex>& at_rest() const { return at_rest_; }
  // From now on that tick is wanted; an older wish is dropped.
  void want(std::size_t index);
  // The newest frame there is; null before the first.
  std::shared_ptr<const ViewFrame> newest() const;
  // Waits for the frame of exactly that tick.
  std::shared_ptr<const ViewFrame> wait_for(std::size_t index);

 private:
  void run();
  std::shared_ptr<const ViewFrame> make(std::size_t index);

  const Model& model_;
  RefinedBody refined_;
  TrackStates states_;
  DrawnBody drawn_;
  std::vector<DrawnVertex> at_rest_;
  const RunTrack& track_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t wanted_ = 0;
  bool asked_ = false, ending_ = false;
  std::shared_ptr<const ViewFrame> newest_;
  std::thread thread_;
};

}  // namespace palpate
