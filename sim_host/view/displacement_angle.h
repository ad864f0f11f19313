// The paper's interpolation of displacements over a surface patch by displacement angles.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

// One corner of a patch.
struct PatchCorner {
  Vec3 displacement;
  Vec3 normal;  // outward, unit
  Real weight = 0;
};

// Luo & Xiao 2006, section V.A: over a patch, the magnitudes |d_i| and the displacement angles theta_i = angle(d_i,
// n_i) are interpolated linearly. The paper leaves two things open, completed here: an angle to the normal fixes no
// direction in space (the azimuth is taken from the tangential part of sum w_i d_i at the point), and the angle of a
// corner that does not move is undefined (such corners are left out of the angle, the other weights rescaled). Where
// the azimuth is undefined as well (tangential part below 1e-12 of the magnitude) the plain linear blend sum w_i d_i is
// returned.
//   m = sum w_i |d_i|, theta = sum w_i theta_i / sum w_i, d = m (cos theta n + sin theta t).
// `normal` is the outward unit normal at the point. Not superposable: apply it per contact and add.
Vec3 displacement_by_angle(const PatchCorner (&corner)[3], Vec3 normal);

}  // namespace palpate
