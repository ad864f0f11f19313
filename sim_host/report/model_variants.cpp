#include "sim_host/report/model_variants.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "config/body/body_card.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

// Modes where the scene states none: those of the shipped scenes.
constexpr std::int32_t kSoft = 4, kLinear = 20;
// A nodal body's elements begin at its surface, whose compliance is stored from every node to every other: 1,600 nodes
// bake in half a minute, 6,000 would be refused.
constexpr std::int32_t kNodalTriangles = 800;

void elastic(SceneDesc& scene, const PressPlace&) {
  scene.contact.backend = Backend::kElastic;
  scene.contact.law = ContactLaw::kTool;
  if (scene.elastic.soft == 0) scene.elastic.soft = kSoft;
  scene.elastic.check_presses = 0;
}
void elastic_one(SceneDesc& scene, const PressPlace& press) {
  elastic(scene, press);
  scene.elastic.soft = 1;
}
void elastic_coarse(SceneDesc& scene, const PressPlace& press) {
  elastic(scene, press);
  if (is_auto(scene.fem.edge_m))
    throw ConfigError("the scene leaves body.fem.edge_mm to the baker: there is nothing to double");
  scene.fem.edge_m *= 2;
}
void nodal(SceneDesc& scene, NodalCarry carry) {
  scene.contact.backend = Backend::kNodal;
  scene.elastic = {};
  scene.nodal.carry = carry;
  scene.body.triangles = std::min(scene.body.triangles, kNodalTriangles);
}
void nodal_far(SceneDesc& scene, const PressPlace&) { nodal(scene, NodalCarry::kFarField); }
void nodal_rest(SceneDesc& scene, const PressPlace&) { nodal(scene, NodalCarry::kRest); }
void nodal_turned(SceneDesc& scene, const PressPlace&) { nodal(scene, NodalCarry::kTurned); }

void response(SceneDesc& scene, ContactLaw law) {
  scene.contact.backend = Backend::kResponse;
  scene.contact.law = law;
  scene.elastic = {};
  scene.fem = {};
}
// Of the ball's radius: the tip's law has no deeper one where tip and body have an effective radius below the ball's,
// and goes on by its tangent.
constexpr double kTipDepthShare = 0.78;

// Principal radii at the top of bodies whose curvature the tip's law does not find by itself.
void curve_at_top(SceneDesc& scene, const PressPlace& press) {
  if (!(press.normal.y > 1 - 1e-9)) return;
  const BodyDesc& body = scene.body;
  const Vec3 h = body.half_axes_m;
  double &one = scene.tip.body_radius_1_m, &two = scene.tip.body_radius_2_m;
  if (body.shape == BodyShape::kEllipsoid || body.shape == BodyShape::kHalfShell)
    one = h.x * h.x / h.y, two = h.z * h.z / h.y;
  if (body.axis != BodyAxis::kZ) return;
  if (body.shape == BodyShape::kRing) one = body.radius_m, two = 0.5 * body.wall_m;
  if (body.shape == BodyShape::kHollowCylinder) one = body.radius_m, two = 0;  // 0: flat
}
void tip(SceneDesc& scene, const PressPlace& press) {
  response(scene, ContactLaw::kTool);
  scene.contact.max_depth_m = std::min(scene.contact.max_depth_m, kTipDepthShare * press.radius_m);
  curve_at_top(scene, press);
}
void tip_parabola(SceneDesc& scene, const PressPlace& press) {
  tip(scene, press);
  scene.tip.sphere = SphereLaw::kParabola;
}
void layer(SceneDesc& scene, const PressPlace& press) {
  tip(scene, press);
  const bool standing = scene.body.shape == BodyShape::kCylinder && scene.body.axis == BodyAxis::kY;
  if (!standing && scene.body.shape != BodyShape::kBox)
    throw ConfigError("a layer is a box or a standing cylinder, as thick everywhere");
  scene.layer.thickness_m = standing ? scene.body.height_m : scene.body.size_m.y;
}
void series(SceneDesc& scene, const PressPlace& press) {
  tip(scene, press);
  scene.series.c0_m_per_N = scene.series.c1_m_per_N2 = kAuto;
}
void table(SceneDesc& scene, const PressPlace& press) {
  tip(scene, press);
  scene.contact.law = ContactLaw::kTable;
  scene.table.source = TableSource::kFem;
}
void points(SceneDesc& scene, ContactLaw law) {
  response(scene, law);
  scene.contact.surface = ContactSurface::kSmooth;
}
void hertz(SceneDesc& scene, const PressPlace& press) {
  points(scene, ContactLaw::kHertz);
  scene.hertz.tool_radius_m = press.radius_m;
  scene.hertz.fit_depth_m = 0.8 * press.depth_m;  // good to 1.25 times that
}
void duffing(SceneDesc& scene, const PressPlace&) { points(scene, ContactLaw::kDuffing); }
void duffing_paper(SceneDesc& scene, const PressPlace&) {
  response(scene, ContactLaw::kDuffing);
  scene.contact.weight = ContactWeight::kPaper;
  scene.duffing.coefficient = DuffingCoefficient::kPaper;
}

constexpr std::array kVariants = {
    ModelVariant{"elastic", "elastic", "reduced elastic body, modes as the scene states them", elastic},
    ModelVariant{"elastic_soft_1", "elastic", "the same with one soft mode", elastic_one},
    ModelVariant{"elastic_coarse", "elastic", "the same on elements twice as long", elastic_coarse},
    ModelVariant{"nodal", "nodal", "linear complementarity on finite elements' nodes, far field carried", nodal_far},
    ModelVariant{"nodal_rest", "nodal", "the same with the normals of rest", nodal_rest},
    ModelVariant{"nodal_turned", "nodal", "the same with nodes turned by the far field", nodal_turned},
    ModelVariant{"tip", "tip", "exact sphere on a half space of E and nu", tip},
    ModelVariant{"tip_parabola", "tip", "Hertz: paraboloid on a half space", tip_parabola},
    ModelVariant{"tip_layer", "tip", "exact sphere on a bonded layer", layer},
    ModelVariant{"tip_series", "tip", "tip in series with a pressed far field", series},
    ModelVariant{"table", "table", "table of large-strain presses", table},
    ModelVariant{"points_hertz", "points", "springs of tool points fitted to Hertz", hertz},
    ModelVariant{"points_duffing", "points", "Duffing's law of Luo & Xiao 2006, which knows no E", duffing},
    ModelVariant{"points_paper", "points", "the same as printed", duffing_paper},
};

// Where the scene says something of its body, which every model keeps.
bool is_of_the_case(const std::string& key) {
  return key.starts_with("body") && !key.starts_with("body.fem") && !key.starts_with("body.elastic");
}

}  // namespace

std::span<const ModelVariant> model_variants() { return kVariants; }

const ModelVariant* find_variant(const std::string& name) {
  for (const ModelVariant& variant : kVariants)
    if (name == variant.name) return &variant;
  return nullptr;
}

SceneDesc scene_of(const ModelVariant& variant, const SceneDesc& stated, const PressPlace& press) {
  SceneDesc scene;
  scene.name = stated.name;
  scene.body = stated.body;
  scene.material = stated.material;
  scene.fixed = stated.fixed;
  scene.fem.edge_m = stated.fem.edge_m;
  scene.fem.level = stated.fem.level;
  scene.elastic.soft = stated.elastic.soft;
  scene.elastic.linear = stated.contact.backend == Backend::kElastic ? stated.elastic.linear : kLinear;
  scene.device = stated.device;
  scene.source = stated.source;
  std::erase_if(scene.source.line, [](const auto& entry) { return !is_of_the_case(entry.first); });
  scene.contact.max_depth_m = std::min(1.05 * press.depth_m, press.radius_m);
  scene.skeleton.law = SkeletonLaw::kNone;
  scene.shape.neighbourhood = NeighbourhoodLaw::kNone;
  scene.friction.law = FrictionLaw::kNone;
  scene.piece = {PieceDesc{}};
  scene.piece[0].radius_m = press.radius_m;
  variant.choose(scene, press);
  check_scene(scene);
  return scene;
}

}  // namespace palpate
