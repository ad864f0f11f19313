// The solved surface of an elastic body: its modes, and under every tip the dent with its true radius.
#pragma once

#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// A dent is drawn out to this many radii, fading over the second half: beyond, the modes hold what the body does.
inline constexpr double kDentReach = 8;

// What goes along the normal is gone this many lengths 1 / cut_1_per_m beyond the contact's edge: the linear modes hold
// all of it there. Without, the surface around a ball was 2 to 6 % of the travel too deep two to four radii away, on
// all of the cases of docs/accuracy.md that were kept back; from 0.7 to 1.4 their mean RMS changes by 0.2 % of it.
inline constexpr double kModesTakeOver = 1.2;

// What a tip in contact adds: the profile of a frictionless contact on a half space (Hertz; Johnson 1985, eq. 3.42),
// an ellipse where a capsule lies on its side, deep enough that the surface meets the tip, and drawn in towards the
// middle as such a contact does. Around it the dent falls as two tips' lean on one another does
// (rt_core/contact/elastic/near_field.h), where the linear modes take over or a wall or a layer ends: a dent of half a
// space around a ball on a pad was 15 % of the travel off, RMS (2026-11-25).
struct TipDent {
  Vec3 foot_w;               // deepest place, on the surface as the modes carry it
  Vec3 inward;               // unit
  Vec3 along;                // unit, of the ellipse's longer axis
  double depth_m;            // what the modes leave of the tip's overlap
  double across_m, along_m;  // the contact's half axes
  double mean_Pa = 0;        // its force over its area
  double cut_1_per_m = 0;    // 1 / the length that the half space ends at; 0: never
  double drawn_in_m = 0;     // at the contact's edge, towards its middle

  // At a point of the carried surface whose normal at rest is `normal`; nothing on sides that face away.
  Vec3 at(Vec3 point_w, Vec3 normal) const;
  double pressure_Pa(Vec3 point_w, Vec3 normal) const;
};

// All that the surface of a state follows from, few numbers: whoever has the modes' shapes makes the surface of it,
// here or in the viewer's vertex shader (sim_host/viewer/shader_surface.h).
struct ElasticShape {
  std::vector<double> soft;    // soft_products: amplitudes, then their pairs
  std::vector<double> linear;  // amplitudes, J^1/2, under the forces of the regions
  std::vector<TipDent> dent;
};
ElasticShape elastic_shape(const Model& model, const State& state);

// By the soft modes (with their second order) and the linear ones; of every vertex.
std::vector<Vec3> mode_displacement_m(const Model& model, const ElasticShape& shape);

}  // namespace palpate
