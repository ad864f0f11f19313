// The deformed surface, evaluated at any point of the rest surface: for drawing and export.
#pragma once

#include <cstdint>

#include "rt_core/state.h"
#include "sim_host/view/neighbourhood.h"
#include "sim_host/view/rbf_surface.h"

namespace palpate {

// What one region in contact does to the surface.
struct ShapeRegion {
  std::int32_t slot = -1;  // in State::region
  Vec3 contact_w;          // equivalent contact point on the rest surface
  Vec3 dent_w;             // displacement of the contact point d_c: -(omega D_eq) along the total force on the tool
  Vec3 local_amplitude_w;  // d_c - u_global(contact): what the local law adds at the contact
  Neighbourhood local;
  Neighbourhood press;      // of a whole tip: its profile and edge, whatever the local law
  Real mean_Pa = 0;         // its normal force over the area within that edge; 0: no tip's
  RbfContact node;          // the contact point as a node of the interpolation, when there is no local law
  Vec3 node_coefficient_w;  // of |x - contact|
  Vec3 anchor_displacement_w[kMaxAnchors];  // by this region
};

// All regions of one state, prepared once and then evaluated per point.
struct ShapeField {
  std::int32_t count = 0;
  bool interpolated = false;    // an RBF interpolation exists
  Vec3 coefficient_w[kMaxRbf];  // of g(x), summed over regions
  ShapeRegion region[kMaxRegions];
};

// Prepares the shape of `state`: u(x) = sum over regions in contact of
//   global shape: anchor displacements spread by the model's ShapeLaw, plus
//   local dent: with a local law (d_c - u_global(p)) g(|x - p|); with NeighbourhoodLaw::kNone the contact point is one
//   more node of the global interpolation and carries d_c itself (the paper's point contact).
// So a single region displaces its contact point by exactly d_c, and fixed anchors keep still unless the local law
// reaches them or the contact sits on them. Regions are superposed: another region's far field adds to d_c, as it is
// what the depth was reduced by. d_c = -(depth_equivalent_m * omega) F/|F| with F the region's total force on the tool,
// omega = region_size_factor.
void prepare_shape(const Model& model, const State& state, ShapeField& field);

// Displacement (m, world) of the rest-surface point `rest_point_w`. `vertex` is its index in Model::vertex_m, or -1:
// the displacement-angle law needs the vertex's patch and normal, and uses the RBF interpolation where there is none.
// Cost: about 60 + 15 n_rbf operations, and a logarithm or arcsine per region within reach.
Vec3 displacement_at(const Model& model, const ShapeField& field, Vec3 rest_point_w, std::int32_t vertex);

// Pressure (Pa) of whole tips there, by the profile with which they dent it. Where that is without bound, at a cone's
// point and a flat end's edge, it ends at this many times the mean.
inline constexpr Real kMostPressure = 2.5;
Real pressure_at(const ShapeField& field, Vec3 rest_point_w);

}  // namespace palpate
