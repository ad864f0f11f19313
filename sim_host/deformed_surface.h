// The whole deformed surface of a body at one state, vertex by vertex: what pictures and ParaView files show. The
// real-time core evaluates the same displacement field on demand only.
#pragma once

#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

struct DeformedSurface {
  std::vector<Vec3> displacement_m;  // world frame, per model vertex
  std::vector<Vec3> position_m;      // rest position plus displacement
  std::vector<Vec3> normal;          // of the deformed surface, angle-weighted, outward
};

// From a given displacement field; `displacement_m` has one entry per model vertex.
DeformedSurface deformed_surface(const Model& model, std::vector<Vec3> displacement_m);
// From the shape models of the scene.
DeformedSurface deformed_surface(const Model& model, const State& state);

}  // namespace palpate
