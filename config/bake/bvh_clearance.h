// Bakes the clearance certificates that let most closest-point queries end without descending the hierarchy.
#pragma once

#include <span>

#include "config/bake/bvh_build.h"

namespace palpate {

// Sets Triangle::clear_* and ring_convex of every triangle of `bvh`. A point q is placed off the centroid along the
// outward normal, and its distance from all surface but the triangle's ring is measured exactly. The certificate: a
// point p at distance d from the triangle, with |p - q| + d <= that distance, has its nearest surface point in the
// ring, because the ball about p lies inside the ball about q, which holds no other surface. The height of q is the
// largest of the body's size, its half, its quarter... that certifies points above the whole triangle up to half the
// height, or the one that comes nearest to that. Triangles without a closed ring, or beside other surface, stay
// uncertified.
void measure_clearance(std::span<const Vec3> vertex_m, BvhBuild& bvh);

}  // namespace palpate
