// Computes what a viewer shows of a tick, state and deformed surface, on a thread of its own: the picture keeps turning
// smoothly however long a surface takes.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "sim_host/view/deformed_surface.h"
#include "sim_host/view/elastic_surface.h"
#include "sim_host/view/run_track.h"
#include "sim_host/view/view_scales.h"

namespace palpate {

// A refined body as a graphics card takes it: corners that share place and normal are one vertex. Vertices stand in the
// order of the surface's points, so that those of a coarser mesh come first.
struct DrawnBody {
  struct Source {
    std::int32_t vertex, triangle, corner;  // of the DeformedSurface; `corner` of the triangle has the normal
  };
  std::vector<Source> source;
  std::vector<std::array<std::uint32_t, 3>> triangle;
};
DrawnBody drawn_body(const std::vector<std::array<std::int32_t, 3>>& triangle,
                     const std::vector<std::array<Vec3, 3>>& corner_normal);
// Of the mesh before its edges were halved the last time (RefinedBody::triangle): of four triangles one.
template <class Corners>
std::vector<Corners> coarser(const std::vector<Corners>& triangle) {
  std::vector<Corners> coarse;
  for (std::size_t t = 0; t + 3 < triangle.size(); t += 4)
    coarse.push_back({triangle[t][0], triangle[t + 1][0], triangle[t + 2][0]});
  return coarse;
}

// Position (m), normal, displacement (m) and pressure (Pa) of one vertex, interleaved.
struct DrawnVertex {
  float position[3], normal[3], displacement_m, pressure_Pa;
};
std::vector<DrawnVertex> drawn_vertices(const DrawnBody& body, const DeformedSurface& surface);

struct ViewFrame {
  std::size_t index = 0;  // of the tick in the track
  StatePtr state;
  std::vector<DrawnVertex> vertex;  // empty where `elastic` stands for them
  std::optional<ElasticShape> elastic;
  std::array<double, 3> largest{};  // by SurfaceColour; of `elastic` not those of the surface
  double made_ms = 0;               // time to compute it
};

class FrameMaker {
 public:
  // `initial`: the state before the track's first tick. Model and track must outlive this. `in_shader`: of an elastic
  // body frames have the shape alone, which somebody else makes the surface of.
  FrameMaker(const Model& model, const RunTrack& track, StatePtr initial, std::size_t most_triangles,
             bool in_shader = false);
  ~FrameMaker();
  FrameMaker(const FrameMaker&) = delete;
  FrameMaker& operator=(const FrameMaker&) = delete;

  bool in_shader() const { return in_shader_; }
  const RefinedBody& refined() const { return refined_; }
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
  const bool in_shader_;
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
