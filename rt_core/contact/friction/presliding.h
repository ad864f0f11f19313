// Pre-sliding friction in two tangential dimensions: an elastic displacement that saturates, after Dahl (1976) and
// Hayward & Armstrong (2000), in the form that neither drifts nor depends on the number of steps.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

struct Presliding {
  Vec3 stretch_w;             // elastic displacement, |stretch| <= slip
  bool sliding = false;       // some of the step slid, or the limit fell below the stretch
  bool ends_sliding = false;  // the step's end slid: further motion along it meets no stiffness
};

// Moves the contact by `step` in the tangent plane with the elastic displacement bounded by slip_m >= 0. Exact for a
// straight step at constant slip distance, hence the same for any division of it: first the elastic part, up to the
// circle |stretch| = slip, then the tractrix along which a point dragged at that distance follows, tan(phi'/2) =
// tan(phi/2) exp(-r / slip), phi the angle from step to stretch, r the sliding part. (A radial return is of first
// order only: after a turn by 90 degrees it errs by up to 14 % of the slip distance.) The adhesion point does not move
// at all below slip: encoder dither cannot make it creep, as it does under Dahl's law. `stretch` and `step` must be
// finite.
Presliding preslide(Vec3 stretch, Vec3 step, Real slip_m) PALPATE_RT;

}  // namespace palpate
