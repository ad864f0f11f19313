// How the body's rest surface bends around a place, from its mesh.
#pragma once

#include "rt_core/model.h"
#include "sim_host/view/contact_profile.h"

namespace palpate {

// The paraboloid that fits the vertices within `radius_m` of a place on the surface with outward normal `normal_w`
// best, among those that face as it does. Flat where they are fewer than twice its six coefficients. Needs vertex
// normals.
SurfaceBend surface_bend(const Model& model, Vec3 place_w, Vec3 normal_w, Real radius_m);

}  // namespace palpate
