// How far the surface that pictures show is from where finite elements see it.
#pragma once

#include <string>
#include <vector>

#include "config/elastic/moved_places.h"
#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

struct ReferenceSurface {
  double depth_m = 0;  // of the press that moved it: the travel
  std::vector<elastic::MovedPlace> place;
};

// Places count that move by more than this share of the travel: the rest of a body is still, in every model.
inline constexpr double kMovedShare = 0.05;

struct SurfaceError {
  double rms = 0;  // of the travel, by area, over the places that move
  // The same less what the whole surface leans aside: the rigid motion across `normal`, shift and tilt, that fits best.
  // Without friction a ball on a crest or a pole holds a body upright by little, or not at all: what leans is then told
  // by how uneven the elements are, in the model and in the reference (docs/accuracy.md).
  double upright_rms = 0;
  double largest = 0;    // of the travel, over all places
  Vec3 at_largest_m;     // at rest
  double still_rms = 0;  // of a surface that does not move at all: what there is to get wrong
};

// Displacements of the drawn surface, as vectors, against those of the reference; `normal`: against which it is
// pressed.
SurfaceError surface_error(const Model& model, const State& state, const ReferenceSurface& reference, Vec3 normal);

// One CSV file: `# depth_mm = `, then x_mm, y_mm, z_mm, ux_mm, uy_mm, uz_mm, area_mm2. Throws std::runtime_error.
ReferenceSurface read_reference_surface(const std::string& path);
void write_reference_surface(const std::string& path, const ReferenceSurface& surface);
// Where it lies: beside CASE.reference.csv.
std::string reference_surface_path(const std::string& reference_path);

}  // namespace palpate
