#include "config/response/press_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "config/bake/contact_fit.h"
#include "config/bake/fem_body.h"
#include "config/body/body.h"
#include "config/body/supports.h"
#include "config/fem/linear_body.h"
#include "config/fem/tet_procedural.h"

namespace palpate {

namespace {

// Latitudes of a round body from pole to pole: neighbouring curves of an ellipsoid of 4 : 3 differ by 0.4 % at most.
constexpr int kLatitudes = 64;
// Rings, and cells along half a side: places within a cell share a curve.
constexpr int kCells = 12;
// Cells of the mesh behind the compliances: about 500 boxes of six quadratic elements, or as fine for round bodies.
constexpr double kMeshCells = 500;
// Solved together: the factor is read once per 16, and 64 loads of 5000 nodes are 15 MB.
constexpr std::size_t kLoadsAtOnce = 64;

// Names a place and puts the vertices of the same name there.
class Gatherer {
 public:
  explicit Gatherer(PressPlaces& places) : places_(places) {}
  using Name = std::array<int, 3>;
  template <class Make>
  void add(const Name& name, const Make& make) {
    const auto [known, is_new] = index_.try_emplace(name, static_cast<std::int32_t>(places_.place.size()));
    if (is_new) places_.place.push_back(make());
    places_.of_vertex.push_back(known->second);
  }

 private:
  PressPlaces& places_;
  std::map<Name, std::int32_t> index_;
};

int cell_of(double x, double half) {
  return std::min(kCells, static_cast<int>(std::lround(kCells * std::abs(x) / half)));
}

// The point at an angle from the upper pole as the ellipse's parameter, in the plane of x and y.
PressPlace round_place(double across, double along, double angle) {
  const double s = std::sin(angle), c = std::cos(angle);
  const double stretch = std::hypot(across * c, along * s);
  PressPlace place;
  place.position_m = {across * s, along * (1 + c), 0};
  place.normal = unit_or({s / across, c / along, 0}, {0, 1, 0});
  place.curvature_1_per_m = across * along / (stretch * stretch * stretch);
  place.curvature_2_per_m = along / (across * stretch);
  return place;
}

void gather_round(double across, double along, const std::vector<Vec3>& vertex_m, PressPlaces& places) {
  Gatherer gather(places);
  gather.add({0, 0, 0}, [&] { return round_place(across, along, 0); });
  places.of_vertex.clear();
  for (const Vec3& v : vertex_m) {
    const double angle = std::acos(std::clamp((v.y - along) / along, -1.0, 1.0));
    const int latitude = static_cast<int>(std::lround(kLatitudes * angle / kPi));
    gather.add({latitude, 0, 0}, [&] { return round_place(across, along, kPi * latitude / kLatitudes); });
  }
}

void gather_cylinder(double radius, double height, const std::vector<Vec3>& vertex_m, PressPlaces& places) {
  Gatherer gather(places);
  gather.add({0, 0, 0}, [&] { return PressPlace{{0, height, 0}, {0, 1, 0}}; });
  places.of_vertex.clear();
  const double sliver = 1e-6 * height;
  for (const Vec3& v : vertex_m) {
    const double r = std::hypot(v.x, v.z);
    if (v.y > height - sliver) {
      const int ring = cell_of(r, radius);
      gather.add({0, ring, 0}, [&] { return PressPlace{{radius * ring / kCells, height, 0}, {0, 1, 0}}; });
    } else if (v.y < sliver && r < radius * (1 - 1e-6)) {
      gather.add({1, 0, 0}, [] { return PressPlace{{}, {0, -1, 0}, 0, 0, false}; });
    } else {
      const int ring = cell_of(v.y, height);
      gather.add({2, ring, 0}, [&] {
        return PressPlace{{radius, height * ring / kCells, 0}, {1, 0, 0}, 1 / radius, 0, false};
      });
    }
  }
}

void gather_box(Vec3 size, const std::vector<Vec3>& vertex_m, PressPlaces& places) {
  Gatherer gather(places);
  gather.add({0, 0, 0}, [&] { return PressPlace{{0, size.y, 0}, {0, 1, 0}}; });
  places.of_vertex.clear();
  const double sliver = 1e-6 * size.y;
  const auto at = [](double side, int cell) { return 0.5 * side * cell / kCells; };
  for (const Vec3& v : vertex_m) {
    const int i = cell_of(v.x, 0.5 * size.x), j = cell_of(v.y, size.y), k = cell_of(v.z, 0.5 * size.z);
    const double y = size.y * j / kCells;
    if (v.y > size.y - sliver)
      gather.add({0, i, k}, [&] { return PressPlace{{at(size.x, i), size.y, at(size.z, k)}, {0, 1, 0}}; });
    else if (v.y < sliver)
      gather.add({1, 0, 0}, [] { return PressPlace{{}, {0, -1, 0}, 0, 0, false}; });
    else if (std::abs(v.x) > 0.5 * size.x - sliver)
      gather.add({2, j, k}, [&] { return PressPlace{{0.5 * size.x, y, at(size.z, k)}, {1, 0, 0}, 0, 0, false}; });
    else
      gather.add({3, i, j}, [&] { return PressPlace{{at(size.x, i), y, 0.5 * size.z}, {0, 0, 1}, 0, 0, false}; });
  }
}

// A coarse mesh of the body, quadratic elements, and the length of its edges.
TetMesh coarse_mesh(const SceneDesc& scene, double& edge_m) {
  if (scene.body.shape == BodyShape::kBox) {
    const Vec3 size = scene.body.size_m;
    edge_m = std::cbrt(size.x * size.y * size.z / kMeshCells);
    const auto cells = [&](double side) { return std::max(2, static_cast<std::int32_t>(std::lround(side / edge_m))); };
    return make_box_tets(size, {cells(size.x), cells(size.y), cells(size.z)});
  }
  SceneDesc coarse = scene;
  coarse.fem.order = FemOrder::kQuadratic;
  std::vector<std::string> warnings;
  coarse.body.triangles = 800;
  const SurfaceMesh surface = make_body(coarse, warnings);
  edge_m = mean_edge_m(surface);
  coarse.fem.edge_m = edge_m;
  return make_tet_mesh(coarse, warnings);
}

// Boundary faces of a quadratic mesh, and loads on them.
class SurfaceLoad {
 public:
  explicit SurfaceLoad(const TetMesh& mesh) : mesh_(mesh) {
    std::map<std::array<std::int32_t, 3>, Face> open;
    for (const Tet& tet : mesh.tet)
      for (std::size_t f = 0; f < 4; ++f) {
        const Face face = face_of(tet, f);
        std::array<std::int32_t, 3> name{face.node[0], face.node[1], face.node[2]};
        std::sort(name.begin(), name.end());
        if (const auto twin = open.find(name); twin != open.end())
          open.erase(twin);
        else
          open.emplace(name, face);
      }
    for (const auto& [name, face] : open) face_.push_back(face);
  }

  // One newton against the normal, spread like exp(-r^2/patch^2) over the faces that look the normal's way.
  std::vector<Vec3> around(const PressPlace& place, double patch_m) const {
    std::vector<double> share(mesh_.node_m.size());
    double total = 0;
    for (const Face& face : face_) {
      const Vec3 a = at(face.node[0]), b = at(face.node[1]), c = at(face.node[2]);
      const Vec3 area = 0.5 * cross(b - a, c - a);
      if (!(dot(area, place.normal) > 0.5 * norm(area))) continue;
      for (const auto& [l, weight] : rule()) {
        const Vec3 x = l[0] * a + l[1] * b + l[2] * c;
        const double load = weight * norm(area) * std::exp(-squared_norm(x - place.position_m) / (patch_m * patch_m));
        total += load;
        for (std::size_t k = 0; k < 3; ++k) {
          share[index(face.node[k])] += load * l[k] * (2 * l[k] - 1);
          share[index(face.node[3 + k])] += load * 4 * l[k] * l[(k + 1) % 3];
        }
      }
    }
    std::vector<Vec3> force(share.size());
    for (std::size_t i = 0; i < share.size(); ++i) force[i] = (-share[i] / total) * place.normal;
    return force;
  }

 private:
  struct Face {
    std::array<std::int32_t, 6> node;  // corners, then the middles of sides 01, 12, 20
  };
  static std::size_t index(std::int32_t node) { return static_cast<std::size_t>(node); }
  Vec3 at(std::int32_t node) const { return mesh_.node_m[index(node)]; }
  static Face face_of(const Tet& tet, std::size_t f) {
    Face face{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto from = static_cast<std::size_t>(kTetFace[f][k]),
                 to = static_cast<std::size_t>(kTetFace[f][(k + 1) % 3]);
      face.node[k] = tet.node[from];
      face.node[3 + k] = tet.node[4 + tet_edge(from, to)];
    }
    return face;
  }
  // Sixteen points: the middles of a face cut into sixteen.
  static const std::vector<std::pair<std::array<double, 3>, double>>& rule() {
    static const auto points = [] {
      std::vector<std::pair<std::array<double, 3>, double>> list;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4 - i; ++j)
          for (const double third : {1.0, 2.0}) {
            const double u = (i + third / 3) / 4, v = (j + third / 3) / 4;
            if (u + v < 1) list.push_back({{1 - u - v, u, v}, 1.0 / 16});
          }
      return list;
    }();
    return points;
  }

  const TetMesh& mesh_;
  std::vector<Face> face_;
};

}  // namespace

PressPlaces press_places(const SceneDesc& scene, const std::vector<Vec3>& vertex_m) {
  const BodyDesc& b = scene.body;
  PressPlaces places;
  places.of_vertex.reserve(vertex_m.size() + 1);
  if (b.shape == BodyShape::kBox)
    gather_box(b.size_m, vertex_m, places);
  else if (b.shape == BodyShape::kCylinder)
    gather_cylinder(b.radius_m, b.height_m, vertex_m, places);
  else if (b.shape == BodyShape::kSphere)
    gather_round(b.radius_m, b.radius_m, vertex_m, places);
  else
    gather_round(b.half_axes_m.x, b.half_axes_m.y, vertex_m, places);
  return places;
}

PlaceCompliance place_compliance(const SceneDesc& scene, const std::vector<PressPlace>& place, double contact_m,
                                 const Progress& progress) {
  PlaceCompliance result;
  double edge_m = 0;
  const TetMesh mesh = coarse_mesh(scene, edge_m);
  result.nodes = mesh.node_m.size();
  result.patch_m = std::max(edge_m, contact_m);
  const double base = standing_base_m(scene, "a press by finite elements") + 1e-9;
  const Supports supports = hold_where(mesh, [base](Vec3 x) { return x.y <= base; });
  const FemMaterial material{scene.material.youngs_modulus_Pa,
                             std::min(effective_poisson_ratio(scene.material), 0.495)};
  const LinearBody body(mesh, material, supports, scene.source.where("body.shape"), progress);
  const SurfaceLoad surface(mesh);
  for (std::size_t first = 0; first < place.size(); first += kLoadsAtOnce) {
    const std::size_t last = std::min(place.size(), first + kLoadsAtOnce);
    std::vector<std::vector<Vec3>> load;
    for (std::size_t i = first; i < last; ++i) load.push_back(surface.around(place[i], result.patch_m));
    const std::vector<std::vector<Vec3>> moved = body.solve_all_m(load);
    for (std::size_t i = 0; i < load.size(); ++i) {
      double work = 0;
      for (std::size_t n = 0; n < mesh.node_m.size(); ++n) work += dot(load[i][n], moved[i][n]);
      result.m_per_N.push_back(work);
    }
    if (progress) progress("pressing places", static_cast<double>(last) / static_cast<double>(place.size()));
  }
  return result;
}

double half_space_patch_m_per_N(double modulus_Pa, double patch_m) {
  return 0.5 * std::sqrt(2 / kPi) / (modulus_Pa * patch_m);
}

}  // namespace palpate
