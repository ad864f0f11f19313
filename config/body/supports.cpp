#include "config/body/supports.h"

#include <algorithm>

#include "config/body/body_card.h"
#include "config/body/body_pose.h"
#include "config/body/support_surface.h"
#include "config/index.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

// Nodes of a flat base are as flat as rounding leaves them.
constexpr double kFlat_m = 1e-9;

// In the order of HeldComponents.
constexpr std::uint8_t kHeld[] = {kHoldAll, 1, 2, 4, 1 | 2, 1 | 4, 2 | 4, kHoldAll};
static_assert(std::size(kHeld) == ChoiceOf<HeldComponents>::kCount);

// Where the scene says it: a list's entries are numbered, a single table is not.
std::string entry_label(const SceneDesc& scene, std::size_t i) {
  const std::string numbered = "body.fixed[" + std::to_string(i) + "]";
  return scene.source.where(scene.source.has(numbered) ? numbered : "body.fixed");
}

bool is_near(const FixedDesc& entry, Vec3 x, Vec3 centre_m) {
  return squared_norm(x - centre_m) <= (entry.radius_m + kFlat_m) * (entry.radius_m + kFlat_m);
}

[[noreturn]] void fail_empty(const std::string& label, const TetMesh& mesh) {
  const Bounds body = bounds_of(surface_of(mesh).mesh);
  throw ConfigError(label + ": holds no node of the body, which reaches from " + position_text(body.lower_m) + " to " +
                    position_text(body.upper_m) +
                    "; move the region to it or make it larger than the edge of an element (body.fem.edge_mm)");
}

// Nodes in an entry's region. Middles of edges were bent to the surface: they are in it with their edges' ends.
std::vector<char> nodes_in(const std::function<bool(Vec3)>& in_it, const TetMesh& mesh) {
  std::vector<char> in(mesh.node_m.size());
  for (std::size_t n = 0; n < in.size(); ++n) in[n] = in_it(mesh.node_m[n]) ? 1 : 0;
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

bool is_bed(const FixedDesc& entry) { return !is_auto(entry.stiffness_N_per_m3); }

// Nodes that an entry holds: of a patch those of the surface that are joined to its middle within it, so that the other
// side of a thin wall is free; of vertices those of the surface.
std::vector<char> nodes_of(const SceneDesc& scene, std::size_t i, const TetMesh& mesh, const TetSurface& skin) {
  const FixedDesc entry = held_regions(scene)[i];
  std::vector<char> in = nodes_in(region_on(scene, i, skin.mesh), mesh);
  if (entry.region == FixedRegion::kPatch)
    keep_joined(skin, nearest_on(skin.mesh, entry.centre_m), in);
  else if (entry.region == FixedRegion::kVertices)
    keep_surface(skin, in);
  if (std::ranges::find(in, 1) == in.end()) fail_empty(entry_label(scene, i), mesh);
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
      return is_near(entry, x_w, entry.centre_m);
    case FixedRegion::kPatch:
    case FixedRegion::kVertices:
      return false;  // they are of a surface: region_on
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
  if (entries.size() == 1 && entries[0].region == FixedRegion::kBase && !is_bed(entries[0]))
    return entries[0].base_height_m;
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
  const TetSurface skin = surface_of(mesh);
  Supports supports(mesh.node_m.size(), 0);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (is_bed(entries[i])) continue;
    const std::vector<char> in = nodes_of(scene, i, mesh, skin);
    for (std::size_t n = 0; n < supports.size(); ++n)
      if (in[n] != 0) supports[n] |= kHeld[static_cast<std::size_t>(entries[i].holds)];
  }
  if (std::ranges::all_of(supports, [](std::uint8_t held) { return held == kHoldAll; }))
    throw ConfigError(entry_label(scene, 0) + ": holds every node of the body: nothing could move; make it smaller");
  return supports;
}

std::vector<ElasticBed> beds_of(const SceneDesc& scene, const TetMesh& mesh) {
  std::vector<ElasticBed> beds;
  if (std::ranges::none_of(scene.fixed, is_bed)) return beds;
  const TetSurface skin = surface_of(mesh);
  for (std::size_t i = 0; i < scene.fixed.size(); ++i) {
    const FixedDesc& entry = scene.fixed[i];
    if (!is_bed(entry)) continue;
    std::vector<char> in = nodes_of(scene, i, mesh, skin);
    keep_surface(skin, in);
    const bool has_triangle = std::ranges::any_of(skin.mesh.triangle, [&](const Corners& t) {
      return std::ranges::all_of(t, [&](std::int32_t v) { return in[at(skin.node[at(v)])] != 0; });
    });
    if (!has_triangle) fail_empty(entry_label(scene, i), mesh);
    beds.push_back({std::move(in), entry.stiffness_N_per_m3, kHeld[static_cast<std::size_t>(entry.holds)],
                    entry.holds == HeldComponents::kNormal});
  }
  return beds;
}

Supports supports_and_beds(Supports supports, const std::vector<ElasticBed>& beds) {
  for (const ElasticBed& bed : beds)
    for (std::size_t n = 0; n < supports.size(); ++n)
      if (bed.node[n] != 0) supports[n] |= bed.components;
  return supports;
}

std::function<bool(Vec3)> region_on(const SceneDesc& scene, std::size_t i, const SurfaceMesh& surface) {
  const FixedDesc entry = held_regions(scene)[i];
  if (entry.region == FixedRegion::kPatch) {
    const Vec3 middle_m = nearest_on(surface, entry.centre_m).place_m;
    return [entry, middle_m](Vec3 x) { return is_near(entry, x, middle_m); };
  }
  if (entry.region == FixedRegion::kVertices) return on_listed_triangles(scene, entry, entry_label(scene, i));
  const double lowest_m = bounds_of(surface).lower_m.y;
  return [entry, lowest_m](Vec3 x) { return in_region(entry, x, lowest_m); };
}

}  // namespace palpate
