// The solved surface of an elastic body: its soft modes, what finite elements gave for a press at the tips' places, and
// under every tip the contact with its true radius.
#pragma once

#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// What a tip in contact adds: half a space under its pressure, which drawn_shapes.h leaves out. In the contact the
// surface lies on the tip: `depth_m` in its middle, `edge_m` at its edge. Around it half a space does as the force says
// (Hertz; Johnson 1985, eqs. 3.42), which at the edge of a ball's contact is `edge_m` too: that says how wide the
// contact is. A contact draws the surface in towards its middle (eqs. 3.41b and 3.42b); a deep ball's pressure leans
// outwards, by the slope of the ball, and spreads the surface (contact_spread). Either moves a place to where the ball
// is higher or lower.
struct TipDent {
  // Unit directions at a tip's foot; the third is what is left of a right-handed frame.
  struct Frame {
    Vec3 inward, along;  // along: the ellipse's longer axis
    Vec3 across() const { return cross(inward, along); }
  };
  Vec3 foot_m;                       // deepest place, on the surface at rest
  Frame rest, now;                   // there, and as everything else carries it
  double depth_m = 0;                // what is left of the tip's overlap
  double across_m = 0, along_m = 0;  // the contact's half axes
  double mean_Pa = 0;                // its force over its area
  double edge_m = 0;                 // of the dent, at the contact's edge
  double far_m = 0;       // depth that a paraboloid of that width and force has, whose dent this is from far away
  double drawn_in_m = 0;  // at the contact's edge, towards its middle
  double spread_m = 0;    // contact_spread's unit: force / (contact modulus x ball's radius)
  // In a ball's contact: its radius, 0 for other tips; what the rest bends at the edge, of the far field and of the
  // body at rest; and how far the far field moves the edge outwards.
  double ball_m = 0, bend_m = 0, out_m = 0;
  double poisson_ratio = 0.5;
  double reach_m = kHuge;  // drawn_shapes::near

  // At a point of the surface at rest, with its normal there; nothing on sides that face away.
  Vec3 at(Vec3 rest_m, Vec3 normal) const;
  double pressure_Pa(Vec3 rest_m, Vec3 normal) const;

 private:
  // Inside, of how much less deep the edge is: where a place comes to lie on the ball.
  double sag_share(double rho) const;
};

// All that the surface of a state follows from, few numbers: whoever has the modes' shapes makes the surface of it,
// here or in the viewer's vertex shader (sim_host/viewer/shader_surface.h).
struct ElasticShape {
  std::vector<double> soft;   // soft_products: amplitudes, then their pairs
  std::vector<double> drawn;  // m, of drawn_shapes.h, by all tips
  std::vector<TipDent> dent;
};
ElasticShape elastic_shape(const Model& model, const State& state);

// By the soft modes (with their second order) and the drawn shapes; of every vertex.
std::vector<Vec3> mode_displacement_m(const Model& model, const ElasticShape& shape);

}  // namespace palpate
