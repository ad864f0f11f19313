// Deformed surfaces for ParaView and other VTK readers: XML unstructured grids (.vtu), numbers as base64, and a .pvd
// index that gives each file its time.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/model.h"
#include "rt_core/record.h"
#include "rt_core/state.h"
#include "sim_host/view/anchors.h"
#include "sim_host/view/deformed_surface.h"

namespace palpate {

// Surface: points are the rest vertices in metres (apply "Warp by vector" with `displacement_m`); point arrays
// displacement_m, displacement_magnitude_mm, normal (of the deformed surface).
std::string surface_vtu(const Model& model, const DeformedSurface& surface);
// Anchors: points at rest; point arrays displacement_m, stress_Pa, axial_stress_Pa, shear_stress_Pa, fixed.
std::string anchors_vtu(const Model& model, const AnchorField& field);

// Contact regions: points are their equivalent contact points; point arrays force_N (on the tool, friction included:
// "Glyph" draws it), normal, depth_equivalent_m, id, friction. In double precision: the numbers of the tick's record,
// to the bit.
std::string regions_vtu(std::span<const RegionRecord> regions);

// A folder of numbered files of surface, anchors and regions; created if missing. Throws std::runtime_error on failure.
class VtuSeries {
 public:
  explicit VtuSeries(const std::string& folder);
  // `record` of the tick whose state that is.
  void add(const Model& model, const State& state, const TickRecord& record, double time_s);
  std::size_t size() const { return times_s_.size(); }
  // Writes surface.pvd, anchors.pvd and regions.pvd; call once at the end.
  void finish() const;

 private:
  std::string folder_;
  std::vector<double> times_s_;
};

// Base64 (RFC 4648) of some bytes.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace palpate
