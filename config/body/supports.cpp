#include "config/body/supports.h"

#include <algorithm>

#include "config/body/body_card.h"
#include "config/body/body_pose.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

// Nodes of a flat base are as flat as rounding leaves them.
constexpr double kFlat_m = 1e-9;

// In the order of HeldComponents.
constexpr std::uint8_t kHeld[] = {kHoldAll, 1, 2, 4, 1 | 2, 1 | 4, 2 | 4};
static_assert(std::size(kHeld) == ChoiceOf<HeldComponents>::kCount);

// Where the scene says it: a list's entries are numbered, a single table is not.
std::string entry_label(const SceneDesc& scene, std::size_t i) {
  const std::string numbered = "body.fixed[" + std::to_string(i) + "]";
  return scene.source.where(scene.source.has(numbered) ? numbered : "body.fixed");
}

double lowest_of(const TetMesh& mesh) {
  double lowest = kHuge;
  for (const Vec3& x : mesh.node_m) lowest = std::min(lowest, x.y);
  return lowest;
}

[[noreturn]] void fail_empty(const std::string& label, const TetMesh& mesh) {
  const Bounds body = bounds_of(surface_of(mesh).mesh);
  throw ConfigError(label + ": holds no node of the body, which reaches from " + position_text(body.lower_m) + " to " +
                    position_text(body.upper_m) +
                    "; move the region to it or make it larger than the edge of an element (body.fem.edge_mm)");
}

// Nodes in an entry's region. A region is convex, but its middles of edges were bent to the surface: they are in it
// with their edges' ends.
std::vector<char> nodes_in(const FixedDesc& entry, const TetMesh& mesh, double lowest_m) {
  std::vector<char> in(mesh.node_m.size());
  for (std::size_t n = 0; n < in.size(); ++n) in[n] = in_region(entry, mesh.node_m[n], lowest_m) ? 1 : 0;
  for (const Tet& tet : mesh.tet)
    for (std::size_t e = 0; e < kTetEdge.size(); ++e) {
      if (tet.node[4 + e] < 0) continue;  // a straight element has no middles
      const auto end = [&](std::size_t k) {
        return static_cast<std::size_t>(tet.node[static_cast<std::size_t>(kTetEdge[e][k])]);
      };
      if (in[end(0)] != 0 && in[end(1)] != 0) in[static_cast<std::size_t>(tet.node[4 + e])] = 1;
    }
  return in;
}

}  // namespace

std::vector<FixedDesc> held_regions(const SceneDesc& scene) {
  return scene.fixed.empty() ? std::vector<FixedDesc>(1) : scene.fixed;
}

bool in_region(const FixedDesc& entry, Vec3 x_w, double lowest_m) {
  switch (entry.region) {
    case FixedRegion::kBase:
      return x_w.y <= lowest_m + entry.base_height_m + kFlat_m;
    case FixedRegion::kBox:
      return x_w.x >= entry.from_m.x - kFlat_m && x_w.x <= entry.to_m.x + kFlat_m &&
             x_w.y >= entry.from_m.y - kFlat_m && x_w.y <= entry.to_m.y + kFlat_m &&
             x_w.z >= entry.from_m.z - kFlat_m && x_w.z <= entry.to_m.z + kFlat_m;
    case FixedRegion::kBall:
      return squared_norm(x_w - entry.centre_m) <= (entry.radius_m + kFlat_m) * (entry.radius_m + kFlat_m);
  }
  return false;
}

bool is_fixed(const SceneDesc& scene, Vec3 x_w, double lowest_m) {
  return std::ranges::any_of(held_regions(scene),
                             [&](const FixedDesc& entry) { return in_region(entry, x_w, lowest_m); });
}

double standing_base_m(const SceneDesc& scene, const std::string& who) {
  if (is_moved(scene.body))
    throw ConfigError(
        scene.source.where(scene.source.has("body.position_mm") ? "body.position_mm" : "body.rotation_deg") + ": " +
        who +
        " knows a body that stands where its shape is made; remove the key, or use contact.backend = \"elastic\"");
  const std::vector<FixedDesc> entries = held_regions(scene);
  if (entries.size() == 1 && entries[0].region == FixedRegion::kBase) return entries[0].base_height_m;
  throw ConfigError(entry_label(scene, 0) + ": " + who +
                    " knows a body that stands on its base alone; hold it by one base_height_mm, or use "
                    "contact.backend = \"elastic\"");
}

Supports supports_of(const SceneDesc& scene, const TetMesh& mesh) {
  if (const auto of_shape = card_of(scene.body.shape).supports; of_shape != nullptr) {
    TetMesh unplaced = mesh;
    take_back(scene.body, unplaced.node_m);
    return of_shape(unplaced);
  }
  const std::vector<FixedDesc> entries = held_regions(scene);
  const double lowest_m = lowest_of(mesh);
  Supports supports(mesh.node_m.size(), 0);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::vector<char> in = nodes_in(entries[i], mesh, lowest_m);
    for (std::size_t n = 0; n < supports.size(); ++n)
      if (in[n] != 0) supports[n] |= kHeld[static_cast<std::size_t>(entries[i].holds)];
    if (std::ranges::find(in, 1) == in.end()) fail_empty(entry_label(scene, i), mesh);
  }
  if (std::ranges::all_of(supports, [](std::uint8_t held) { return held == kHoldAll; }))
    throw ConfigError(entry_label(scene, 0) + ": holds every node of the body: nothing could move; make it smaller");
  return supports;
}

}  // namespace palpate
