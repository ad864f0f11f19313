// A soft body of Bullet (Coumans; position-based links on the surface): the body's mesh, clamped at one end as in the
// scene, touched by the pieces of the tool as kinematic bodies. One step is what it needs instead of one of our ticks.
#pragma once

#include <memory>
#include <span>

#include "config/body/mesh.h"
#include "rt_core/vec.h"

namespace palpate::peers {

class BulletPeer {
 public:
  // `held`: whether a vertex of the body stands still; `pieces`: closed convex surfaces in the frames of the pieces.
  BulletPeer(const SurfaceMesh& body, std::span<const bool> held, std::span<const SurfaceMesh> pieces, double period_s);
  ~BulletPeer();
  BulletPeer(const BulletPeer&) = delete;
  BulletPeer& operator=(const BulletPeer&) = delete;
  void step(std::span<const Pose> piece_w);
  // The farthest that a vertex is from where it was at rest.
  double largest_displacement_m() const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace palpate::peers
