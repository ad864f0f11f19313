// What a state's contacts do to the body's anchors: displacements, stresses and forces at the end of the skeleton's
// beams. For drawing, tables and export; the tick computes forces without it.
#pragma once

#include <cstdint>
#include <vector>

#include "rt_core/limits.h"
#include "rt_core/model.h"
#include "rt_core/skeleton/beam_table.h"
#include "rt_core/skeleton/skeleton.h"
#include "rt_core/state.h"

namespace palpate {

// Stresses on the clamped section of one beam.
struct BeamStress {
  Real axial_Pa = 0;  // F_x / S, tension positive
  Real bending_Pa =
      0;  // |F_perp| l r / I at the extreme fibre, >= 0. On the centre line, where the paper takes it, it is 0
  Real shear_Pa = 0;  // tau(0,0) >= 0, along the transverse force
};

// At the clamped end of a straight beam under tip force `tip_force` (the force on the beam).
BeamStress straight_beam_stress(const StraightBeam& beam, const BeamSection& section, Real poisson_ratio,
                                Vec3 tip_force);

// Stress and displacement of anchor `index` (< count) under its baked beam's share of the force. stress.bending_Pa is
// what the extreme fibre adds to the mean, so that |axial| + bending is the stress there.
struct BeamTableAnchor {
  BeamStress stress;
  Vec3 displacement_w;  // zero for a fixed anchor
};
BeamTableAnchor beam_table_anchor(const Model& model, const BeamTableSkeleton& skeleton, std::int32_t index);

struct AnchorLoad {
  Vec3 displacement_w;  // sum over regions
  Vec3 force_w;         // of its beams on their tips, sum over regions
  // Stress at the anchor, in every table, plot and file: the extreme-fibre stress of the beams that end there, summed
  // over regions: what all contacts do together, as an upper bound, since the fibres need not coincide.
  double stress_Pa = 0;
  double axial_stress_Pa = 0;  // its mean over the section, tension positive, summed likewise
  double shear_stress_Pa = 0;
};

struct AnchorField {
  std::int32_t count = 0;  // anchors with a skeleton; 0: the scene has none
  AnchorLoad anchor[kMaxAnchors];
  Vec3 by_region_w[kMaxRegions][kMaxAnchors];  // displacement of each anchor by each region
  std::int32_t degenerate = 0;  // regions whose skeleton had no usable stiffness: their anchors keep still
};

// One skeleton per region in contact, first born first. With CouplingLaw::kTemporalPaper beams end at the anchors
// as the earlier regions displaced them.
AnchorField anchors_of(const Model& model, const State& state);

}  // namespace palpate
