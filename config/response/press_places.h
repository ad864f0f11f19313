// Where a body is pressed: places that stand for all vertices equivalent to them, and how much softer or stiffer the
// whole body is there than at its top.
#pragma once

#include <vector>

#include "config/scene/progress.h"
#include "config/scene/scene.h"

namespace palpate {

struct PressPlace {
  Vec3 position_m;
  Vec3 normal;
  double curvature_1_per_m = 0, curvature_2_per_m = 0;  // of the body
  bool pressed_face = true;                             // false: a face that is not the top of a block
};
struct PressPlaces {
  std::vector<PressPlace> place;  // 0: the top
  std::vector<std::int32_t> of_vertex;
};
// One place per latitude (sphere, ellipsoid of revolution), per ring (standing cylinder) or per cell of a face's
// quarter (box). The scene's body must be one that pressed_body() takes.
PressPlaces press_places(const SceneDesc& scene, const std::vector<Vec3>& vertex_m);

// Compliance for a smooth load along the normal around each place, by linear elasticity on a coarse mesh of the whole
// body; the load p ~ exp(-r^2/patch^2) is the same everywhere, so that differences are those of the body. m/N.
struct PlaceCompliance {
  std::vector<double> m_per_N;
  double patch_m = 0;
  std::size_t nodes = 0;
};
// `contact_m`: radius of the largest contact, the least patch. Throws ConfigError.
PlaceCompliance place_compliance(const SceneDesc& scene, const std::vector<PressPlace>& place, double contact_m,
                                 const Progress& progress);
// The same load on a half space: sqrt(2/pi)/2 / (E* patch).
double half_space_patch_m_per_N(double modulus_Pa, double patch_m);

}  // namespace palpate
