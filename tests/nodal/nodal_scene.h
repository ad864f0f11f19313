// Scenes of the nodal back-end made in code: a condensed body, a tool and a model that a tick accepts.
#pragma once

#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "config/bake/nodal_body.h"
#include "config/bake/tool_points.h"
#include "config/bake/worst_tick.h"
#include "config/fem/tet_procedural.h"
#include "rt_core/contact/nodes/node_problem.h"
#include "rt_core/image.h"
#include "rt_core/tick.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {

struct NodalSceneOptions {
  double young_Pa = 3e6, poisson = 0.45;
  double mu = 0;
  CompliancePrecision precision = CompliancePrecision::kDouble;
  NodalCarry carry = NodalCarry::kFarField;
  double coupling_N_per_m = 1500, coupling_Nm_per_rad = 0.5;
  std::vector<float> strain_gauge = {};  // as Model::strain_gauge
  double strain_limit = 1;
};

class NodalScene {
 public:
  NodalScene(const CondensedBody& body, const std::vector<PieceDesc>& pieces, const NodalSceneOptions& options) {
    ImageContents& image = image_;
    image.name = "nodal";
    image.params = tiny_params();
    add_nodal_body(body, options.precision, "test", image);
    ModelParams& p = image.params;
    p.backend = Backend::kNodal;
    image.strain_gauge = options.strain_gauge;
    p.strain_limit = options.strain_limit;
    p.nodal_sweeps = 20;
    p.friction_sweeps = 10;
    p.nodal_carry = options.carry;
    p.contact_margin_m = 0.5 * mean_edge_m(body.surface);
    p.regularisation = options.precision == CompliancePrecision::kDouble ? 1e-6 : 1e-5;
    p.wall_N_per_m = 5e4;
    p.proxy_speed_max_m_per_s = 0.5;
    p.friction_law = options.mu > 0 ? FrictionLaw::kCoulomb : FrictionLaw::kNone;
    p.friction_mu_dynamic = options.mu;
    p.youngs_modulus_Pa = options.young_Pa;
    p.poisson_ratio = options.poisson;
    p.cluster_distance_m = 3 * mean_edge_m(body.surface);
    p.coupling_N_per_m = options.coupling_N_per_m;
    p.coupling_Nm_per_rad = options.coupling_Nm_per_rad;
    p.force_max_N = kWireForceMax_N;
    p.torque_max_Nm = kWireTorqueMax_Nm;
    p.force_rate_max_N_per_s = 1e7;
    p.ramp_in_s = 0;
    p.speed_max_m_per_s = 100;
    p.turn_max_rad_per_s = 30;
    put_tool(make_tool(pieces), image);
    reopen();
    state_ = make_state(model_);
    scratch_ = make_scratch(model_);
    restart();
  }

  ModelParams& params() { return image_.params; }
  // After a change of the parameters, which may change what a tick costs at most.
  void reopen() {
    state_most_costs(image_);
    const std::vector<std::byte> bytes = write_image(image_);
    bytes_ = std::make_unique<ImageBytes>(bytes.size());
    std::memcpy(bytes_->bytes().data(), bytes.data(), bytes.size());
    const ImageResult result = open_image(bytes_->bytes(), model_);
    if (result.error != ImageError::kNone) throw std::runtime_error(result.field);
  }
  void restart() {
    reset(*state_);
    test::poison(*scratch_, model_, 0xAB);  // nothing may depend on old scratch
    first_ = true;
  }
  // One tick with the tool held at a place (kTool) or pulled by a handle there (kDevice).
  const Output& tick_at(Vec3 position, Drive drive = Drive::kTool, Quat orientation = {}) {
    Input input;
    input.pose_w = {position, orientation};
    input.drive = drive;
    input.commands = first_ ? Command::kArm : 0;
    first_ = false;
    tick(model_, *state_, *scratch_, input, output_);
    return output_;
  }
  // Ticks at one place until the far field has settled.
  const Output& settle_at(Vec3 position, int ticks = 8) {
    for (int k = 0; k < ticks; ++k) tick_at(position);
    return output_;
  }
  // From one place to another in equal steps; the start is not ticked.
  const Output& move(Vec3 from, Vec3 to, int ticks, Drive drive = Drive::kTool) {
    for (int k = 1; k <= ticks; ++k) tick_at(from + (static_cast<double>(k) / ticks) * (to - from), drive);
    return output_;
  }

  const Model& model() const { return model_; }
  State& state() { return *state_; }
  const Scratch& scratch() const { return *scratch_; }
  const Output& output() const { return output_; }

 private:
  ImageContents image_;
  std::unique_ptr<ImageBytes> bytes_;
  Model model_;
  StatePtr state_;
  ScratchPtr scratch_;
  Output output_{};
  bool first_ = true;
};

inline PieceDesc sphere_piece(double radius_m) {
  PieceDesc piece;
  piece.shape = PieceShape::kSphere;
  piece.radius_m = radius_m;
  return piece;
}
// Axis along the tool's z.
inline PieceDesc cylinder_piece(double radius_m, double length_m, double margin_m) {
  PieceDesc piece;
  piece.shape = PieceShape::kCylinder;
  piece.radius_m = radius_m;
  piece.length_m = length_m;
  piece.margin_m = margin_m;
  piece.points = 9;
  return piece;
}

}  // namespace palpate::test
