// Where the places of a body's surface go under a load: what a solved press says of the surface, as a table.
#pragma once

#include <vector>

#include "config/fem/large_strain_mesh.h"
#include "rt_core/vec.h"

namespace palpate::elastic {

struct MovedPlace {
  Vec3 rest_m, displacement_m;
  double area_m2 = 0;  // of the surface it stands for, at rest
};

// The middle of every facet. `u_m`: [node][component].
std::vector<MovedPlace> moved_places(const fem::StrainMesh<3>& mesh, const std::vector<double>& u_m);
// Of a body of revolution whose profile (radius, height) has its top at height 0, which is `top_m` in the world, the
// axis along y: each place of the profile at another angle around it.
std::vector<MovedPlace> moved_places(const fem::StrainMesh<2>& profile, const std::vector<double>& u_m, Vec3 top_m);
// So many that they are `kThinned` of their distance from `near_m` plus `fine_m` apart; each takes the area of those
// nearest to it.
inline constexpr double kThinned = 0.2;
std::vector<MovedPlace> thinned(const std::vector<MovedPlace>& places, Vec3 near_m, double fine_m);

}  // namespace palpate::elastic
