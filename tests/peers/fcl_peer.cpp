#include "tests/peers/fcl_peer.h"

#include <fcl/fcl.h>

#include <vector>

namespace palpate::peers {

namespace {

using Hierarchy = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Hierarchy> hierarchy_of(const SurfaceMesh& mesh) {
  std::vector<fcl::Vector3d> vertices;
  std::vector<fcl::Triangle> triangles;
  for (const Vec3& v : mesh.vertex_m) vertices.emplace_back(v.x, v.y, v.z);
  for (const Corners& t : mesh.triangle)
    triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                           static_cast<std::size_t>(t[2]));
  auto model = std::make_shared<Hierarchy>();
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

}  // namespace

struct FclPeer::Objects {
  std::unique_ptr<fcl::CollisionObjectd> body;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> piece;
};

FclPeer::FclPeer(const SurfaceMesh& body, std::span<const SurfaceMesh> pieces) : objects_(std::make_unique<Objects>()) {
  objects_->body = std::make_unique<fcl::CollisionObjectd>(hierarchy_of(body));
  for (const SurfaceMesh& piece : pieces)
    objects_->piece.push_back(std::make_unique<fcl::CollisionObjectd>(hierarchy_of(piece)));
}
FclPeer::~FclPeer() = default;

std::size_t FclPeer::contacts(std::span<const Pose> piece_w, std::size_t most) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < objects_->piece.size(); ++i) {
    fcl::CollisionObjectd& piece = *objects_->piece[i];
    const Quat q = piece_w[i].orientation;
    const Vec3 at = piece_w[i].position_m;
    piece.setTransform(fcl::Quaterniond(q.w, q.x, q.y, q.z), fcl::Vector3d(at.x, at.y, at.z));
    piece.computeAABB();
    // As a scene manager would: boxes first.
    if (!piece.getAABB().overlap(objects_->body->getAABB())) continue;
    const fcl::CollisionRequestd request(most, true);
    fcl::CollisionResultd result;
    found += fcl::collide(objects_->body.get(), &piece, request, result);
  }
  return found;
}

}  // namespace palpate::peers
