// Bakes the clearance certificates that let most closest-point queries end without descending the hierarchy.
#pragma once

#include <span>

#include "config/bvh_build.h"

namespace palpate {

// Sets Triangle::clear_* of every triangle of `bvh`. A point q is placed off the centroid along the outward normal, as
// far as possible up to a quarter of the body's size (halved until the nearest surface is the triangle's own
// neighbourhood), and its distance from all surface but the triangle's ring is measured exactly. The certificate: a
// point p at distance d from the triangle, with |p - q| + d <= that distance, has its nearest surface point in the
// ring, because the ball about p lies inside the ball about q, which holds no other surface.
void measure_clearance(std::span<const Vec3> vertex_m, BvhBuild& bvh);

}  // namespace palpate
