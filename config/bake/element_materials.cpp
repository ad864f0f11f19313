#include "config/bake/element_materials.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "config/index.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

// Places in an element: lattice points of this many steps, moved inwards so that each stands for the same volume.
constexpr int kSteps = 4;

std::array<Vec3, 4> corners_of(const TetMesh& mesh, const Tet& tet) {
  std::array<Vec3, 4> corner;
  for (std::size_t k = 0; k < 4; ++k) corner[k] = mesh.node_m[at(tet.node[k])];
  return corner;
}
Vec3 middle_of(const std::array<Vec3, 4>& c) { return 0.25 * (c[0] + c[1] + c[2] + c[3]); }

std::vector<Vec3> places_in(const std::array<Vec3, 4>& c) {
  std::vector<Vec3> places;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps - i; ++j)
      for (int k = 0; k <= kSteps - i - j; ++k) {
        const double share[4] = {i + 0.25, j + 0.25, k + 0.25, kSteps - i - j - k + 0.25};
        Vec3 p;
        for (std::size_t n = 0; n < 4; ++n) p += (share[n] / (kSteps + 1)) * c[n];
        places.push_back(p);
      }
  return places;
}

bool has(const MaterialRegionDesc& region, Vec3 x) {
  if (region.region == MaterialShape::kBall)
    return squared_norm(x - region.centre_m) <= region.radius_m * region.radius_m;
  const Vec3 a = region.from_m, b = region.to_m;
  return x.x >= a.x && x.x <= b.x && x.y >= a.y && x.y <= b.y && x.z >= a.z && x.z <= b.z;
}

std::string known_groups(const TetMesh& mesh) {
  std::string text;
  for (const auto& [number, name] : mesh.group_name) {
    text += (text.empty() ? "" : ", ") + std::to_string(number);
    if (!name.empty()) text += " (\"" + name + "\")";
  }
  return text;
}

// Number of the group that a region names.
std::int32_t group_of(const MaterialRegionDesc& region, const TetMesh& mesh, const std::string& label) {
  if (mesh.group_name.empty())
    throw ConfigError(label +
                      ".group: the body has no groups; they are those of a .msh file (Physical Volume in gmsh), "
                      "with body.shape = \"tets\"");
  for (const auto& [number, name] : mesh.group_name)
    if (region.group == name || region.group == std::to_string(number)) return number;
  throw ConfigError(label + ".group: \"" + region.group + "\" is no group of the mesh, which has " +
                    known_groups(mesh));
}

// Elements of a mesh by the cells of a grid that their boxes meet.
class ElementGrid {
 public:
  explicit ElementGrid(const TetMesh& mesh) : mesh_(mesh), box_(bounds_of(mesh.node_m)) {
    cells_ = std::clamp(static_cast<int>(std::cbrt(static_cast<double>(mesh.tet.size()))), 1, 100);
    for (std::size_t t = 0; t < mesh.tet.size(); ++t) {
      const std::array<Vec3, 4> c = corners_of(mesh, mesh.tet[t]);
      const Bounds box = bounds_of(c);
      const auto from = cell(box.lower_m), to = cell(box.upper_m);
      for (int i = from[0]; i <= to[0]; ++i)
        for (int j = from[1]; j <= to[1]; ++j)
          for (int k = from[2]; k <= to[2]; ++k) element_[place({i, j, k})].push_back(t);
    }
  }
  // The element that has the point, or comes nearest to having it among those of its cell; the first without any.
  std::size_t find(Vec3 p) const {
    std::size_t best = 0;
    double most = -kHuge;
    const auto found = element_.find(place(cell(p)));
    if (found == element_.end()) return best;
    for (const std::size_t t : found->second) {
      const double inside = least_share(corners_of(mesh_, mesh_.tet[t]), p);
      if (!(inside > most)) continue;
      most = inside;
      best = t;
    }
    return best;
  }

 private:
  using Cell = std::array<int, 3>;
  Cell cell(Vec3 p) const {
    const auto one = [&](double x, double low, double high) {
      const double share = high > low ? (x - low) / (high - low) : 0;
      return std::clamp(static_cast<int>(share * cells_), 0, cells_ - 1);
    };
    return {one(p.x, box_.lower_m.x, box_.upper_m.x), one(p.y, box_.lower_m.y, box_.upper_m.y),
            one(p.z, box_.lower_m.z, box_.upper_m.z)};
  }
  int place(const Cell& c) const { return (c[0] * cells_ + c[1]) * cells_ + c[2]; }
  // The least of the point's volume coordinates: negative outside.
  static double least_share(const std::array<Vec3, 4>& c, Vec3 p) {
    const double whole = dot(cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]);
    double least = kHuge;
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<Vec3, 4> with = c;
      with[k] = p;
      least = std::min(least, dot(cross(with[1] - with[0], with[2] - with[0]), with[3] - with[0]) / whole);
    }
    return least;
  }

  const TetMesh& mesh_;
  Bounds box_;
  int cells_ = 1;
  std::map<int, std::vector<std::size_t>> element_;
};

}  // namespace

std::vector<fem::ElementMaterial> element_materials(const SceneDesc& scene, const TetMesh& mesh) {
  const std::vector<MaterialRegionDesc>& regions = scene.material_region;
  if (regions.empty()) return {};
  std::vector<std::int32_t> group(regions.size(), -1);
  std::vector<bool> is_met(regions.size());
  const auto label = [&](std::size_t i) {
    return scene.source.where("body.material_region[" + std::to_string(i) + "]");
  };
  for (std::size_t i = 0; i < regions.size(); ++i)
    if (regions[i].region == MaterialShape::kGroup) group[i] = group_of(regions[i], mesh, label(i));
  std::vector<fem::ElementMaterial> material;
  for (std::size_t t = 0; t < mesh.tet.size(); ++t) {
    const std::vector<Vec3> places = places_in(corners_of(mesh, mesh.tet[t]));
    fem::ElementMaterial sum;
    for (const Vec3 p : places) {
      fem::ElementMaterial here{scene.material.youngs_modulus_Pa, scene.material.poisson_ratio};
      for (std::size_t i = 0; i < regions.size(); ++i) {
        const bool inside = group[i] >= 0 ? mesh.group[t] == group[i] : has(regions[i], p);
        if (!inside) continue;
        is_met[i] = true;
        here.youngs_modulus_Pa = regions[i].youngs_modulus_Pa;
        here.poisson_ratio =
            is_auto(regions[i].poisson_ratio) ? scene.material.poisson_ratio : regions[i].poisson_ratio;
      }
      sum.youngs_modulus_Pa += here.youngs_modulus_Pa / static_cast<double>(places.size());
      sum.poisson_ratio += here.poisson_ratio / static_cast<double>(places.size());
    }
    material.push_back(sum);
  }
  for (std::size_t i = 0; i < regions.size(); ++i)
    if (!is_met[i]) {
      const Bounds body = bounds_of(mesh.node_m);
      throw ConfigError(label(i) + ": has nothing of the body, which reaches from " + position_text(body.lower_m) +
                        " to " + position_text(body.upper_m) +
                        "; move the region to it or make it larger than an element (body.fem.edge_mm)");
    }
  return material;
}

void take_groups(const TetMesh& from, TetMesh& mesh) {
  mesh.group_name = from.group_name;
  mesh.group.clear();
  if (from.group.empty()) return;
  const ElementGrid grid(from);
  for (const Tet& tet : mesh.tet) mesh.group.push_back(from.group[grid.find(middle_of(corners_of(mesh, tet)))]);
}

}  // namespace palpate
