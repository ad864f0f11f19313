#include "sim_host/bake/default_path.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "config/body/mesh.h"

namespace palpate {

namespace {

constexpr double kGap_m = 0.02;
constexpr double kDeepest = 0.1;  // of the body's height, at most half the law's depth: every law holds there
constexpr double kSlide = 0.1;    // of the body's length along x

// Of the tool, turned as it is described, below its origin.
double lowest_of_tool_m(const Model& model) {
  double lowest = kHuge;
  for (const ToolPoint& point : model.tool_point) lowest = std::min(lowest, point.position_tool_m.y - point.margin_m);
  return lowest;
}

constexpr double kTop = 1e-3;  // of the body's height: what is no lower is its top

// Of a body's top the vertex nearest to its middle: of a flat one no corner or rim, from which the tool would slide.
Vec3 middle_of_top(const Model& model, const Bounds& body) {
  const double lowest = body.upper_m.y - kTop * body.size_m().y;
  Vec3 sum;
  double count = 0;
  for (const Vec3& p : model.vertex_m)
    if (p.y >= lowest) sum += p, count += 1;
  const Vec3 middle = (1 / count) * sum;
  return *std::ranges::min_element(model.vertex_m, {},
                                   [&](Vec3 p) { return p.y >= lowest ? squared_norm(p - middle) : kHuge; });
}

}  // namespace

bool add_default_path(SceneDesc& scene, const Model& model) {
  if (!scene.path.point.empty() || scene.articulation != Articulation::kRigid || model.vertex_m.empty()) return false;
  const Bounds body = bounds_of(model.vertex_m);
  const Vec3 top = middle_of_top(model, body);
  const Vec3 touching = top - Vec3{0, lowest_of_tool_m(model), 0}, above = touching + Vec3{0, kGap_m, 0};
  const double depth_m = std::min(kDeepest * body.size_m().y, 0.5 * scene.contact.max_depth_m);
  const Vec3 pressed = touching - Vec3{0, depth_m, 0}, slid = pressed + Vec3{kSlide * body.size_m().x, 0, 0};
  const auto add = [&](double time_s, Vec3 position_m) {
    PathPoint point;
    point.time_s = time_s;
    point.position_m = position_m;
    scene.path.point.push_back(point);
  };
  add(0, above);
  add(1, touching);
  add(3, pressed);
  add(4, pressed);
  add(8, slid);
  add(9, slid + Vec3{0, kGap_m, 0});
  add(10, above);
  return true;
}

PathDesc path_of_image(const Model& model) {
  SceneDesc scene;
  scene.articulation = model.params.articulation;
  scene.contact.max_depth_m = model.params.max_depth_m;
  if (!add_default_path(scene, model))
    throw std::runtime_error(std::string(model.name) +
                             ": an image holds no motion, and how fingers close is not to be guessed; name the scene's "
                             ".toml, or give --path CSV");
  return scene.path;
}

}  // namespace palpate
