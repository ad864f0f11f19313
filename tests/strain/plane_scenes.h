// The plane reference scenes: a thick ring between plates, a snap clip on a
// tube, a ring under two fingers. SI units.
#pragma once

#include "config/fem/large_strain_solver.h"
#include "tests/strain/arm_series.h"
#include "tests/strain/pair_states.h"
#include "tests/strain/strain_scenes.h"

namespace palpate::fem {

// D: ring a = 20 mm, b = 30 mm, 10 mm wide, E = 3 MPa, nu = 0.45, between two
// frictionless plates. A quarter is solved.
struct RingBetweenPlates {
  RingBetweenPlates(int quarter_elements, Kinematics kinematics, StrainLaw law);
  double force_N(double approach_m);  // of both plates together; approaches must rise
  LargeStrainSolver<2> solver;
};

// F: C-shaped clip, inner radius 10 mm, 2 mm thick, 10 mm wide, arms to 50
// degrees from +y with round tips, E = 2 GPa, nu = 0.35, outer arc within 20
// degrees of -y fixed; a rigid tube of 10 mm radius comes down along y. Half is
// solved.
inline constexpr double kClipTubeRadius_m = 0.010, kClipTipRadius_m = 0.001, kClipTipCentreRadius_m = 0.011;
inline constexpr double kClipArmEnd_rad = 40 * 3.14159265358979323846 / 180;  // polar angle of the tip's centre
double clip_first_contact_m();  // height of the tube's centre when it first
                                // touches, 14.14133 mm
struct ClipMesh {
  StrainMesh<2> mesh;
  std::vector<bool> fixed;
  std::vector<int> contact_nodes;
  int tip_node = 0;  // centre of the tip's circle
};
ClipMesh clip_mesh(double element_m);
StrainBody clip_material();
// The half clip's arm from two linear and two large-strain dead loads at its
// tip.
ArmSeries bake_clip_arm(double element_m);
struct ClipOnTube {
  explicit ClipOnTube(double element_m);
  struct State {
    double force_N = 0,
           energy_J = 0;  // of the whole clip; positive resists insertion
  };
  State insert(double insertion_m);
  LargeStrainSolver<2> solver;
};

// The same clip, its tips spread along x by a frictionless face instead of the
// tube.
struct ClipSpread {
  explicit ClipSpread(double element_m);
  double force_N(double travel_m);  // of one arm; travels must rise
  LargeStrainSolver<2> solver;
};

// G2: plane-strain ring like D's, outer arc within 25 degrees of -y fixed, two
// rigid cylinders of 8 mm radius at the polar angles 90 and 20 degrees, pressed
// towards the centre.
struct RingUnderFingers {
  RingUnderFingers(double contact_element_m, StrainLaw law);
  struct Forces {
    double first_N = 0, second_N = 0, energy_J = 0;
  };
  Forces press(double first_m, double second_m);
  // Inward displacement at the second finger's place per force of the first,
  // pressed alone.
  double compliance_at_second_m_per_N(double first_m);
  StrainMesh<2> mesh;
  LargeStrainSolver<2> solver;
};

// E: hollow cylinder, radii 20 and 30 mm, 60 mm long, E = 3 MPa, nu = 0.45,
// between two opposed spheres of 8 mm radius at mid length; an eighth is
// solved, in space.
struct HollowCylinder {
  HollowCylinder(double contact_element_m, int fine_count, StrainLaw law);
  double force_N(double depth_m);  // of one finger; depths must rise
  LargeStrainSolver<3> solver;
};

// Every pair of the depths (and zero) for both fingers; single-finger tables
// every `table_step_mm`; coupling fitted to the pairs (largest, least), (least,
// largest) and (largest, largest), all others held out.
struct FingerError {
  double held_out_rms = 0;  // root mean square of force errors over that of the
                            // forces, states not fitted
};
struct FingerStudy {
  std::vector<PairState> states;
  PairCoupling coupling;
  FingerError linear, uncoupled, first_order, second_order;
};
FingerStudy study_two_fingers(double contact_element_m, const std::vector<double>& depths_mm, double table_step_mm);

}  // namespace palpate::fem
