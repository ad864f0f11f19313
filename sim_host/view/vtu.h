// Deformed surfaces for ParaView and other VTK readers: XML unstructured grids (.vtu), numbers as base64, and a .pvd
// index that gives each file its time.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"
#include "sim_host/view/anchors.h"
#include "sim_host/view/deformed_surface.h"

namespace palpate {

// Surface: points are the rest vertices in metres (apply "Warp by vector" with `displacement_m`); point arrays
// displacement_m, displacement_magnitude_mm, normal (of the deformed surface).
std::string surface_vtu(const Model& model, const DeformedSurface& surface);
// Anchors: points at rest; point arrays displacement_m, stress_Pa, axial_stress_Pa, shear_stress_Pa, fixed.
std::string anchors_vtu(const Model& model, const AnchorField& field);

// A folder of numbered surface and anchor files; created if missing. Throws std::runtime_error on failure.
class VtuSeries {
 public:
  explicit VtuSeries(const std::string& folder);
  void add(const Model& model, const State& state, double time_s);
  // Writes surface.pvd and anchors.pvd; call once at the end.
  void finish() const;

 private:
  std::string folder_;
  std::vector<double> times_s_;
};

// Base64 (RFC 4648) of some bytes.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace palpate
