#include "sim_host/fit/press_forward.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "config/scene/config_error.h"
#include "rt_core/tick.h"
#include "sim_host/press/press.h"
#include "sim_host/tick_memory.h"

namespace palpate {

namespace {

// Measured rows may be far apart; between them the tool moves no faster than this a tick.
constexpr double kLongestStep_m = 5e-5;

// Poses with what lies between them, and which of them were measured.
struct FinePath {
  std::vector<TimedPose> pose;
  std::vector<std::size_t> measured;
};
FinePath fine_path(const std::vector<TimedPose>& poses) {
  FinePath path;
  for (const TimedPose& pose : poses) {
    if (!path.pose.empty()) {
      const Vec3 from = path.pose.back().tool_w.position_m, way = pose.tool_w.position_m - from;
      const int steps = std::min(4000, static_cast<int>(norm(way) / kLongestStep_m));
      for (int k = 1; k <= steps; ++k) {
        TimedPose between = pose;
        between.tool_w.position_m = from + (static_cast<double>(k) / (steps + 1)) * way;
        path.pose.push_back(between);
      }
    }
    path.pose.push_back(pose);
    path.measured.push_back(path.pose.size() - 1);
  }
  return path;
}

// Height of the tool's origin above the body's highest point where the tool begins to touch it.
TimedPose touching_pose(const Model& model) {
  Vec3 top{0, -kHuge, 0};
  for (const Vec3& vertex : model.vertex_m)
    if (vertex.y > top.y) top = vertex;
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  Input input;
  input.drive = Drive::kTool;
  Output output;
  double reach = 0;
  for (const ToolPoint& point : model.tool_point) reach = std::max(reach, norm(point.position_tool_m) + point.margin_m);
  constexpr int kSteps = 2000;
  for (int k = 0; k <= kSteps; ++k) {
    input.pose_w.position_m = top + Vec3{0, reach * (1.001 - 2.0 * k / kSteps), 0};
    tick(model, *state, *scratch, input, output);
    if (!(output.penetration_m > 0)) continue;
    TimedPose pose;
    pose.tool_w.position_m = input.pose_w.position_m + Vec3{0, output.penetration_m, 0};
    return pose;
  }
  throw std::runtime_error(
      "the scene's tool does not reach the body's highest point from above: give poses (x_mm, y_mm, z_mm)");
}

bool knows_modulus(const SceneDesc& scene) {
  if (scene.contact.backend != Backend::kResponse) return true;
  return scene.contact.law == ContactLaw::kTool || scene.contact.law == ContactLaw::kHertz ||
         (scene.contact.law == ContactLaw::kTable && scene.table.source == TableSource::kFem);
}

}  // namespace

Measurement read_measurement(const CsvTable& table, const Model& model) {
  Measurement out;
  out.vectors = table.has("fx_N");
  const bool depths = !table.has("x_mm");
  const TimedPose touching = depths ? touching_pose(model) : TimedPose{};
  const auto cell = [&](const char* name, std::size_t row, double otherwise) {
    return table.has(name) ? table.column(name)[row] : otherwise;
  };
  const std::vector<double>& first = table.column(depths ? "depth_mm" : "x_mm");
  const std::vector<double>& force = table.column(out.vectors ? "fx_N" : table.has("f_N") ? "f_N" : "force_N");
  for (std::size_t i = 0; i < table.rows(); ++i) {
    TimedPose pose = touching;
    pose.time_s = 1e-3 * static_cast<double>(i);
    pose.tool_w.position_m = depths ? touching.tool_w.position_m - Vec3{0, 1e-3 * first[i], 0}
                                    : 1e-3 * Vec3{first[i], table.column("y_mm")[i], table.column("z_mm")[i]};
    pose.tool_w.orientation = {cell("qw", i, 1), cell("qx", i, 0), cell("qy", i, 0), cell("qz", i, 0)};
    const Vec3 f =
        out.vectors ? Vec3{force[i], table.column("fy_N")[i], table.column("fz_N")[i]} : Vec3{force[i], 0, 0};
    if (!std::isfinite(norm(f)) || !std::isfinite(norm(pose.tool_w.position_m))) continue;
    out.pose.push_back(pose);
    out.force_N.push_back(f);
  }
  return out;
}

PressForward::PressForward(const SceneDesc& scene, const Measurement& measurement)
    : scene_(scene), measurement_(measurement), baked_Pa_(scene.material.youngs_modulus_Pa) {
  if (!knows_modulus(scene))
    throw ConfigError(scene.source.where("contact.law") +
                      ": the forces of this law do not know Young's modulus; fit with contact.backend = \"elastic\", "
                      "contact.law = \"tool\", or a table that the baker presses");
  scene_.error_target.clear();  // one model for all guesses
}

void PressForward::settle(double youngs_modulus_Pa) {
  baked_Pa_ = youngs_modulus_Pa;
  forces_.clear();
}

std::vector<Vec3> PressForward::operator()(const MaterialGuess& material) {
  const std::pair key{material.poisson_ratio, material.friction};
  const auto [entry, is_new] = forces_.try_emplace(key);
  if (is_new) {
    SceneDesc scene = scene_;
    scene.material.youngs_modulus_Pa = baked_Pa_;
    scene.material.poisson_ratio = material.poisson_ratio;
    if (scene.friction.law != FrictionLaw::kNone) scene.friction.mu_ref = material.friction;
    const SceneModel baked(scene);
    bakes_ += 1;
    const FinePath path = fine_path(measurement_.pose);
    const StatePtr state = make_state(baked.model());
    std::size_t tick = 0, next = 0;
    press(baked.model(), path.pose, {}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
      if (next < path.measured.size() && tick++ == path.measured[next]) {
        const Vec3 force = row.record.output.contact_w.force_N;
        entry->second.push_back(measurement_.vectors ? force : Vec3{norm(force), 0, 0});
        next += 1;
      }
    });
  }
  std::vector<Vec3> force = entry->second;
  for (Vec3& f : force) f = (material.youngs_modulus_Pa / baked_Pa_) * f;
  return force;
}

}  // namespace palpate
