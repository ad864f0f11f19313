// The sharp edges of a surface: those on whose two sides the corners' normals differ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/model.h"

namespace palpate {

struct Crease {
  std::int32_t vertex[2];  // the smaller first
  struct Side {
    std::size_t triangle, corner;  // the edge goes from that corner to the next
  };
  Side side[2];  // in the order of the triangles
};
std::vector<Crease> creases(std::span<const CornerNormals> normal, std::span<const Triangle> triangles);

}  // namespace palpate
