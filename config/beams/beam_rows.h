// Mechanics of one baked beam: what its tip's stiffness and its anchor's response are in the world frame.
#pragma once

#include <Eigen/Core>

#include "config/beams/beam_selection.h"
#include "config/beams/circular_beam.h"
#include "rt_core/model.h"

namespace palpate {

// Rectangular section: `width_m` in the plane of the curve, `thickness_m` across it.
struct BeamBuild {
  BeamMaterial material;
  double width_m = 0, thickness_m = 0;
  double release_length_m = 0;  // over which the clamp is released to find the anchor's displacement
  bool paper = false;
  double equivalent_radius_m() const;  // of the circle of the same area
};

// Compliance of the tip of a beam along any curve of middle-line points, by Gauss quadrature of
//   C = int t t^T/(ES) + 1.2 (1 - t t^T)/(GS) + [rho]^T (t t^T/(GJ) + n n^T/(E I_n) + b b^T/(E I_b)) [rho] dx,
// rho from the section to the tip: axial force, shear, torsion and both bendings, exact for straight beams; for an arc
// 8 points leave 1e-13 of the thin-beam integral, and that is 2 to 10 % from elasticity at h/R = 0.29.
Eigen::Matrix3d curve_compliance(const BeamCurve& curve, const BeamBuild& build);
// Displacement of the middle line's point `release_length_m` from the clamp per tip force (the general form of
// released_displacement; for a straight beam it is that).
Eigen::Matrix3d release_compliance(const BeamCurve& curve, const BeamBuild& build);
// The elastic half space under the clamp: a rigid circular foot of the section's area, (1 - nu^2)/(2 E r) along the
// normal, (2 - nu)/(8 G r) across it. It is what keeps a beam of no length finite.
Eigen::Matrix3d foot_compliance(const BeamBuild& build, Vec3 anchor_normal);

struct BeamRows {
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  // of tip with foot
  Eigen::Matrix3d release = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 6, 3> stress = Eigen::Matrix<double, 6, 3>::Zero();  // rows as in BeamResponse
  BeamRatio ratio{};                                                         // paper's law only
};
BeamRows beam_rows(const BeamCurve& curve, const BeamBuild& build, Vec3 anchor_normal);
// Two ways round: stiffnesses add by weight, responses by the force each way carries.
BeamRows beam_rows(const BeamChoice& choice, const BeamBuild& build, Vec3 anchor_normal);

}  // namespace palpate
