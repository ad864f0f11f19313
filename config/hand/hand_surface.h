// Tool points on the surface of the hand's mesh: with hand.contact = "mesh" a finger part touches with the palm's side
// of what is drawn, its pad and knuckles, instead of with a rod of the table's width.
#pragma once

#include <vector>

#include "config/bake/tool_points.h"

namespace palpate {

// Points per part: `at_most`, or the most below it that fill rows of one, three or five.
std::int32_t surface_point_count(std::int32_t at_most);

// Moves the points of all finger parts of `tool` (surface_point_count each, roots of the parts at -z) onto the palm's
// side of their meshes: spheres of a quarter of the part's radius that touch the surface from inside, in rows along the
// part; symmetric to the bit about its middle plane, so that a left hand is the mirror image. gap_m becomes the largest
// distance from that strip of the mesh to the nearest sphere.
void touch_with_mesh(Tool& tool);

}  // namespace palpate
