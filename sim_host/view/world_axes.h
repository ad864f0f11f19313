// The axes of the world in a view's corner: where they point on the screen, and in which colours.
#pragma once

#include <algorithm>
#include <array>

#include "sim_host/view/mesh_raster.h"
#include "sim_host/view/plot.h"

namespace palpate {

struct WorldAxis {
  Vec3 way;
  const char* name;
  Colour colour;
  double right = 0, down = 0;  // of its end, of a length of 1
};

// The farthest first, in the order in which they are drawn.
inline std::array<WorldAxis, 3> world_axes(const Projection& projection) {
  std::array<WorldAxis, 3> axes{
      {{{1, 0, 0}, "x", colour(0xc0504d)}, {{0, 1, 0}, "y", colour(0x5a9a4b)}, {{0, 0, 1}, "z", colour(0x3c78b4)}}};
  std::ranges::sort(axes, {}, [&](const WorldAxis& a) { return -dot(a.way, projection.forward()); });
  for (WorldAxis& a : axes) {
    a.right = dot(a.way, projection.right());
    a.down = -dot(a.way, projection.up());
  }
  return axes;
}

}  // namespace palpate
