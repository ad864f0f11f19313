// A scene's forces at measured poses for any material: what `palpate fit` compares with a measurement.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "sim_host/bake/scene_model.h"
#include "sim_host/fit/fit_material.h"
#include "sim_host/press/pose_csv.h"
#include "sim_host/report/csv_table.h"

namespace palpate {

struct Measurement {
  std::vector<TimedPose> pose;
  std::vector<Vec3> force_N;
  bool vectors = true;  // false: only sizes were measured; forces stand in x
};
// Rows of poses (x_mm, y_mm, z_mm) with forces, as `palpate press` writes them, or of depths (depth_mm) of a press of
// the scene's tool at its highest point. Rows without a number are left out. Throws std::runtime_error.
Measurement read_measurement(const CsvTable& table, const Model& model);

// Bakes once per Poisson's ratio and coefficient of friction: forces are taken to grow like E from the E that was
// baked, which settle() makes true.
class PressForward {
 public:
  // Throws ConfigError when the scene's forces do not depend on E.
  PressForward(const SceneDesc& scene, const Measurement& measurement);
  std::vector<Vec3> operator()(const MaterialGuess& material);
  // Bakes anew at this E from now on.
  void settle(double youngs_modulus_Pa);
  int bakes() const { return bakes_; }

 private:
  SceneDesc scene_;
  const Measurement& measurement_;
  double baked_Pa_;
  int bakes_ = 0;
  std::map<std::pair<double, double>, std::vector<Vec3>> forces_;  // of the baked E, by nu and friction
};

}  // namespace palpate
