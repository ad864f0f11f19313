#include "tests/peers/bullet_peer.h"

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <vector>

namespace palpate::peers {

namespace {

// Bullet's library computes in single precision and its margins are made for metres: lengths are told to it in
// decimetres, as its users do with small things.
constexpr double kPerMetre = 10;
constexpr float kMargin = 0.01F;  // 1 mm

btVector3 scaled(Vec3 v) {
  return {static_cast<float>(kPerMetre * v.x), static_cast<float>(kPerMetre * v.y),
          static_cast<float>(kPerMetre * v.z)};
}
btTransform placed(const Pose& pose) {
  const Quat q = pose.orientation;
  const btQuaternion turn(static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
                          static_cast<float>(q.w));
  return btTransform(turn, scaled(pose.position_m));
}

}  // namespace

struct BulletPeer::World {
  double period_s;
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld dynamics{&dispatcher, &broadphase, &solver, &configuration};
  std::unique_ptr<btSoftBody> soft;
  std::vector<btVector3> rest;
  std::vector<std::unique_ptr<btConvexHullShape>> shape;
  std::vector<std::unique_ptr<btRigidBody>> piece;

  explicit World(double period) : period_s(period) {
    dynamics.setGravity(btVector3(0, 0, 0));
    dynamics.getWorldInfo().m_gravity.setValue(0, 0, 0);
    dynamics.getWorldInfo().m_sparsesdf.Initialize();
  }
  ~World() {
    for (const auto& body : piece) dynamics.removeRigidBody(body.get());
    if (soft) dynamics.removeSoftBody(soft.get());
  }
};

BulletPeer::BulletPeer(const SurfaceMesh& body, std::span<const bool> held, std::span<const SurfaceMesh> pieces,
                       double period_s)
    : world_(std::make_unique<World>(period_s)) {
  std::vector<float> vertex;
  std::vector<int> corner;
  for (const Vec3& v : body.vertex_m)
    for (const double x : {v.x, v.y, v.z}) vertex.push_back(static_cast<float>(kPerMetre * x));
  for (const Corners& t : body.triangle) corner.insert(corner.end(), {t[0], t[1], t[2]});
  world_->soft.reset(btSoftBodyHelpers::CreateFromTriMesh(world_->dynamics.getWorldInfo(), vertex.data(), corner.data(),
                                                          static_cast<int>(body.triangle.size()), false));
  btSoftBody& soft = *world_->soft;
  // As in Bullet's own demonstration of a closed volume.
  soft.m_materials[0]->m_kLST = 0.9F;
  soft.generateBendingConstraints(2, soft.m_materials[0]);
  soft.m_cfg.piterations = 4;
  soft.m_cfg.kDF = 0.5F;
  soft.m_cfg.kVC = 20;
  soft.m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
  soft.getCollisionShape()->setMargin(kMargin);
  soft.setTotalMass(0.1F, true);
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i]) soft.setMass(static_cast<int>(i), 0);
  soft.setPose(true, false);
  world_->dynamics.addSoftBody(&soft);
  for (int i = 0; i < soft.m_nodes.size(); ++i) world_->rest.push_back(soft.m_nodes[i].m_x);
  for (const SurfaceMesh& mesh : pieces) {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3& v : mesh.vertex_m) hull->addPoint(scaled(v), false);
    hull->recalcLocalAabb();
    hull->setMargin(kMargin / 10);
    auto rigid = std::make_unique<btRigidBody>(0.0F, nullptr, hull.get());
    rigid->setCollisionFlags(rigid->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    rigid->setActivationState(DISABLE_DEACTIVATION);
    world_->dynamics.addRigidBody(rigid.get());
    world_->shape.push_back(std::move(hull));
    world_->piece.push_back(std::move(rigid));
  }
}
BulletPeer::~BulletPeer() = default;

void BulletPeer::step(std::span<const Pose> piece_w) {
  for (std::size_t i = 0; i < world_->piece.size(); ++i) {
    const btTransform at = placed(piece_w[i]);
    world_->piece[i]->setWorldTransform(at);
    world_->piece[i]->setInterpolationWorldTransform(at);
  }
  world_->dynamics.stepSimulation(static_cast<float>(world_->period_s), 0);
}

double BulletPeer::largest_displacement_m() const {
  double most = 0;
  for (int i = 0; i < world_->soft->m_nodes.size(); ++i)
    most = std::fmax(most, double{(world_->soft->m_nodes[i].m_x - world_->rest[static_cast<std::size_t>(i)]).length()});
  return most / kPerMetre;
}

}  // namespace palpate::peers
