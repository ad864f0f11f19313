// Where a surface has sharp edges that stand out, and how far places on its faces are from them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "config/elastic/edge_law.h"
#include "rt_core/model.h"

namespace palpate {

class SharpEdges {
 public:
  SharpEdges() = default;  // none
  // Sharp where the corners' normals on both sides differ. Edges between two vertices that are held are none: what
  // holds them carries more than the body that is not there.
  SharpEdges(std::span<const Vec3> vertex_m, std::span<const CornerNormals> normal, std::span<const Triangle> triangles,
             const std::vector<bool>& held);
  // The nearest one straight across a face that looks along `outward`, if there is one within `within_m`. None on faces
  // that bend, from which the law is not read, nor where the face is no wider than `narrow_m`, for whose two edges
  // together it is none: elements tell what such places give, as far as they can.
  std::optional<elastic::SharpEdge> about(Vec3 place_m, Vec3 outward, double within_m, double narrow_m) const;

 private:
  struct Segment {
    Vec3 from_m, to_m;
    Vec3 normal[2], out[2];  // of the two faces; along each of them, away from it
    bool is_flat[2];         // whether the face is, along the edge
    double opening_rad;
    double middle_x_m;
  };
  std::vector<Segment> segments_;  // by middle_x_m
  double longest_m_ = 0;
};

}  // namespace palpate
