// Scenes and the ticks of one's own, as Python sees them.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim_host/bake/scene_model.h"
#include "sim_host/python/record_arrays.h"
#include "sim_host/record/recording_writer.h"
#include "sim_host/tick_memory.h"

namespace palpate {

using DoubleArray = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

// A baked scene.
class PyScene {
 public:
  PyScene(const std::string& path, const std::vector<std::string>& overlay, const std::vector<std::string>& setting);
  const Model& model() const { return scene_->model(); }
  std::span<const std::byte> bytes() const { return scene_->bytes(); }
  // Writes the image, complete or not at all.
  void save(const std::string& path) const;
  pybind11::dict params() const;
  pybind11::dict param_meanings() const;
  pybind11::array vertices() const;
  pybind11::array triangles() const;
  // (time_s, x, y, z, qw, qx, qy, qz) rows of the motion the scene scripts, one a tick; and its hand's stiffness.
  pybind11::array demo_path() const;
  double demo_hand_N_per_m() const;
  // Rows as above without the time; empty: the scene's own. Returns (ticks, regions).
  pybind11::tuple press(const DoubleArray& poses, const DoubleArray& closing, double hand_N_per_m) const;

 private:
  const SceneDesc& description(const char* wanted) const;
  std::unique_ptr<SceneModel> scene_;
};

// State and scratch of one scene, ticked one period at a time.
class PyController {
 public:
  PyController(std::shared_ptr<PyScene> scene, bool keep);
  void reset();
  // Everything of this tick is then in ticks() and regions().
  void tick(const std::array<double, 7>& pose, int drive, unsigned stale, unsigned commands, unsigned device_fault,
            unsigned buttons, const std::array<float, kMaxFingers>& closing);
  // (ticks, regions): one row, and the regions in contact.
  pybind11::tuple last() const;
  // The same of every tick since the last call.
  pybind11::tuple kept() { return kept_.take(); }
  // Device force (N) and torque (N m) of the last tick: what a device callback is called with.
  std::array<double, 6> device_wrench() const;
  int mode() const { return static_cast<int>(record_.output.mode); }
  std::uint64_t state_hash() const;
  pybind11::array deformed_surface() const;
  // From now on each tick is also written to a recording, which a replay verifies; before the first tick only.
  void record_to(const std::string& path, const std::string& image_path);
  void finish_recording();

 private:
  std::shared_ptr<PyScene> scene_;
  StatePtr state_;
  ScratchPtr scratch_;
  TickRecord record_{};
  bool keep_;
  RecordArrays kept_;
  std::unique_ptr<RecordingWriter> writer_;
};

}  // namespace palpate
