// The smallest scene that passes the loader: a tetrahedron and a sphere tool, written by hand so that the tests of the
// loader do not depend on the baker. Bytes are aligned as a mapped file would be.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "rt_core/image.h"
#include "rt_core/stage_cost.h"

namespace palpate::test {

struct alignas(kImageAlignment) Block {
  std::byte bytes[kImageAlignment];
};

// Owns image bytes at the alignment a mapped file has.
class ImageBytes {
 public:
  explicit ImageBytes(std::size_t size) : blocks_((size + kImageAlignment - 1) / kImageAlignment), size_(size) {}
  std::span<std::byte> bytes() { return {blocks_.data()->bytes, size_}; }
  ImageHeader& header() { return *reinterpret_cast<ImageHeader*>(blocks_.data()); }
  ModelSizes& sizes() { return *reinterpret_cast<ModelSizes*>(bytes().data() + image_sections().sizes); }
  ModelParams& params() { return *reinterpret_cast<ModelParams*>(bytes().data() + image_sections().params); }
  template <class T>
  T* array(std::size_t index) {
    std::uint64_t offset[kArrayCount + 1];
    image_offsets(sizes(), offset);
    return reinterpret_cast<T*>(bytes().data() + offset[index]);
  }
  // Makes the checksum fit the bytes again, so that a test reaches the rungs behind it.
  void seal() { header().checksum = image_checksum(bytes()); }

 private:
  std::vector<Block> blocks_;
  std::size_t size_;
};

inline ModelParams tiny_params() {
  ModelParams p{};
  p.contact_weight = ContactWeight::kWinkler;
  p.friction_law = FrictionLaw::kReturnMap;
  p.coupling_law = CouplingLaw::kCoupled;
  p.silence_hold_ticks = 1;
  p.silence_passive_ticks = 5;
  p.silence_fault_ticks = 20;
  p.late_ticks_max = 10;
  p.stall_max_s = 0.02;
  p.period_s = 1e-3;
  p.k1_N_per_m = 40;
  p.k3_N_per_m3 = 3e8;
  p.max_depth_m = 0.01;
  p.friction_k_N = 1;
  p.friction_beta = 0.75;
  p.friction_mu_dynamic = 0.5;
  p.cluster_distance_m = 5e-3;
  p.youngs_modulus_Pa = 3e6;
  p.poisson_ratio = 0.47;
  p.far_field_radius_m = 0.01;
  p.neighbourhood_radius_m = 0.01;
  p.surface_size_m = 0.1;
  p.coupling_N_per_m = 1500;
  p.coupling_Nm_per_rad = 0.5;
  p.force_max_N = 8.5;
  p.torque_max_Nm = 0.2;
  p.force_rate_max_N_per_s = 2e4;
  p.ramp_in_s = 0.2;
  p.ramp_out_s = 0.02;
  p.speed_max_m_per_s = 2;
  p.turn_max_rad_per_s = 30;
  return p;
}

// Indices into the array table.
enum ArrayIndex {
#define PALPATE_FIELD(type, name, count, frame, meaning) k_##name,
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
};
inline constexpr ArrayIndex kVertex = k_vertex_m, kNormal = k_vertex_normal, kTriangle = k_triangle, kBvh = k_bvh,
                            kAnchor = k_anchor, kRbf = k_rbf_inverse, kPatch = k_patch, kPiece = k_piece,
                            kToolPoint = k_tool_point, kHull = k_hull_vertex_m, kNodalVertex = k_nodal_vertex,
                            kCompliance32 = k_compliance_f32, kCompliance64 = k_compliance_f64,
                            kStrainGauge = k_strain_gauge;

// `nodal`: the tetrahedron as a finite-element body held at its fourth corner, 1e-4 m/N per free component.
inline ImageBytes tiny_image(bool nodal = false) {
  ModelSizes sizes{};
  if (nodal) {
    sizes.n_nodal = 4;
    sizes.n_compliance_f64 = 144;
    sizes.n_strain_gauge = 72;
  }
  sizes.n_stage = kStageCount;
  sizes.n_vertex = 4;
  sizes.n_triangle = 4;
  sizes.n_bvh = 1;
  sizes.n_anchor = 1;
  sizes.n_rbf = 2;
  sizes.n_rbf2 = 4;
  sizes.n_piece = 1;
  sizes.n_tool_point = 1;
  std::uint64_t offset[kArrayCount + 1];
  image_offsets(sizes, offset);
  ImageBytes image(offset[kArrayCount]);
  image.header() = {kImageMagic, kImageVersion, sizeof(Real), image_layout_hash(), offset[kArrayCount], 0, "tiny"};
  image.sizes() = sizes;
  image.params() = tiny_params();

  const Real a = 0.03;
  const Vec3 corner[4] = {{a, a, a}, {a, -a, -a}, {-a, a, -a}, {-a, -a, a}};
  for (int i = 0; i < 4; ++i) {
    image.array<Vec3>(kVertex)[i] = corner[i];
    image.array<Vec3>(kNormal)[i] = unit_or(corner[i], {0, 0, 1});
  }
  // Each triangle leaves out one corner; across edge (v[k], v[k+1]) lies the triangle that leaves out v[k+2].
  const Triangle triangles[4] = {
      {{1, 3, 2}, {2, 1, 3}}, {{0, 2, 3}, {3, 0, 2}}, {{0, 3, 1}, {1, 0, 3}}, {{0, 1, 2}, {2, 0, 1}}};
  for (int i = 0; i < 4; ++i) image.array<Triangle>(kTriangle)[i] = triangles[i];
  BvhNode& node = *image.array<BvhNode>(kBvh);
  node = BvhNode{};
  for (int k = 0; k < 4; ++k) {
    node.child[k] = -1;
    for (int axis = 0; axis < 3; ++axis) {
      node.lower_m[axis][k] = -0.031f;
      node.upper_m[axis][k] = 0.031f;
    }
  }
  node.child[0] = ~0;
  node.count[0] = 4;
  *image.array<Anchor>(kAnchor) = {{a, a, a}, unit_or({1, 1, 1}, {}), 1e-4, 1e-9, 5e-3, 6e-3, 0, 0};
  const double rbf[4] = {0, 1, 1, 0};
  std::memcpy(image.array<double>(kRbf), rbf, sizeof(rbf));
  *image.array<ToolPiece>(kPiece) = {{}, {0, 0, 0}, 0.01, 0.01, PieceShape::kSphere, 0, 1, 0, 0, 0, 0, 0, 0};
  *image.array<ToolPoint>(kToolPoint) = {{}, 0.01, 1e-4, 1, 0, 0};
  if (nodal) {
    ModelParams& p = image.params();
    p.backend = Backend::kNodal;
    p.friction_law = FrictionLaw::kNone;
    p.contact_margin_m = 2e-4;
    p.wall_N_per_m = 5e4;
    p.proxy_speed_max_m_per_s = 0.5;
    for (std::int32_t i = 0; i < 4; ++i) {
      image.array<NodalVertex>(kNodalVertex)[i] = {1e-3, i < 3 ? 1 : 0, 0, {}, 1};
    }
    for (int i = 0; i < 9; ++i) image.array<double>(kCompliance64)[13 * i] = 1e-4;
    for (int i = 0; i < 72; ++i) image.array<float>(kStrainGauge)[i] = 1e-3f;
  }
  Model model;
  model.params = image.params();
  model.sizes = image.sizes();
  for (int i = 0; i < kStageCount; ++i) {
    image.array<StageCost>(k_stage_cost)[i] = {most_stage_cost(model, static_cast<Stage>(i))};
  }
  image.seal();
  return image;
}

}  // namespace palpate::test
