#include "config/fem/large_strain_mesh.h"

#include <cmath>
#include <map>
#include <string>

#include "config/scene/config_error.h"

namespace palpate::fem {

namespace {

// Nodes by position, in cells of the weld distance: a point within it lies in the same cell or in a neighbour.
class Welder {
 public:
  Welder(std::vector<Point<2>>& nodes, double weld) : nodes_(nodes), weld_(weld) {}

  int add(const Point<2>& p) {
    const long i = std::lround(p[0] / weld_), j = std::lround(p[1] / weld_);
    for (long di = -1; di <= 1; ++di)
      for (long dj = -1; dj <= 1; ++dj)
        if (const auto found = cells_.find({i + di, j + dj}); found != cells_.end()) return found->second;
    nodes_.push_back(p);
    return cells_[{i, j}] = static_cast<int>(nodes_.size()) - 1;
  }

 private:
  std::vector<Point<2>>& nodes_;
  double weld_;
  std::map<std::pair<long, long>, int> cells_;
};

double doubled_area(const Point<2>& a, const Point<2>& b, const Point<2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

void check_orientation(const StrainMesh<2>& mesh) {
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int* n = &mesh.connectivity[static_cast<std::size_t>(9 * e)];
    const auto at = [&](int i) { return mesh.nodes_m[static_cast<std::size_t>(n[i])]; };
    if (!(doubled_area(at(0), at(2), at(8)) + doubled_area(at(0), at(8), at(6)) > 0))
      throw ConfigError("large-strain mesh: element " + std::to_string(e) +
                        " is turned inside out; reverse one direction of its patch");
  }
}

}  // namespace

int nodes_per_element(StrainElement element) {
  switch (element) {
    case StrainElement::kQ9:
      return 9;
    case StrainElement::kH27:
      return 27;
    case StrainElement::kT10:
      return 10;
  }
  return 0;
}

StrainMesh<2> make_plane_mesh(const std::vector<GridPatch>& patches, double weld_m) {
  StrainMesh<2> mesh;
  Welder welder(mesh.nodes_m, weld_m);
  const auto parameter = [](const std::vector<double>& edges, std::size_t half) {
    return half % 2 == 0 ? edges[half / 2] : 0.5 * (edges[half / 2] + edges[half / 2 + 1]);
  };
  for (const GridPatch& patch : patches) {
    const std::size_t columns = 2 * patch.s.size() - 1, rows = 2 * patch.t.size() - 1;
    std::vector<int> id(columns * rows);
    for (std::size_t j = 0; j < rows; ++j)
      for (std::size_t i = 0; i < columns; ++i)
        id[j * columns + i] = welder.add(patch.map(parameter(patch.s, i), parameter(patch.t, j)));
    for (std::size_t j = 0; j + 2 < rows; j += 2)
      for (std::size_t i = 0; i + 2 < columns; i += 2)
        for (std::size_t b = 0; b < 3; ++b)
          for (std::size_t a = 0; a < 3; ++a) mesh.connectivity.push_back(id[(j + b) * columns + i + a]);
  }
  check_orientation(mesh);
  return mesh;
}

StrainMesh<3> sweep(const StrainMesh<2>& plane, const std::vector<double>& z_m) {
  StrainMesh<3> mesh;
  const std::size_t layers = 2 * z_m.size() - 1;
  for (std::size_t k = 0; k < layers; ++k) {
    const double z = k % 2 == 0 ? z_m[k / 2] : 0.5 * (z_m[k / 2] + z_m[k / 2 + 1]);
    for (const Point<2>& p : plane.nodes_m) mesh.nodes_m.push_back({p[0], p[1], z});
  }
  for (std::size_t k = 0; k + 2 < layers; k += 2)
    for (int e = 0; e < plane.element_count(); ++e)
      for (std::size_t c = 0; c < 3; ++c)
        for (int a = 0; a < 9; ++a)
          mesh.connectivity.push_back(plane.connectivity[static_cast<std::size_t>(9 * e + a)] +
                                      static_cast<int>(k + c) * plane.node_count());
  return mesh;
}

template <int kDim>
std::vector<int> nodes_where(const StrainMesh<kDim>& mesh, const std::function<bool(const Point<kDim>&)>& inside) {
  std::vector<int> found;
  for (int i = 0; i < mesh.node_count(); ++i)
    if (inside(mesh.nodes_m[static_cast<std::size_t>(i)])) found.push_back(i);
  return found;
}
template std::vector<int> nodes_where<2>(const StrainMesh<2>&, const std::function<bool(const Point<2>&)>&);
template std::vector<int> nodes_where<3>(const StrainMesh<3>&, const std::function<bool(const Point<3>&)>&);

std::vector<double> uniform_steps(double from, double to, int count) {
  std::vector<double> edges;
  for (int i = 0; i <= count; ++i) edges.push_back(from + (to - from) * i / count);
  return edges;
}

std::vector<double> graded_steps(double from, double fine_end, double to, int fine_count, double ratio) {
  std::vector<double> edges = uniform_steps(from, fine_end, fine_count);
  const double rest = to - fine_end;
  if (!(std::abs(rest) > 1e-9 * std::abs(to - from))) return edges;
  std::vector<double> sizes;
  double size = (fine_end - from) / fine_count, sum = 0;
  while (std::abs(sum) < std::abs(rest)) {
    size *= ratio;
    sizes.push_back(size);
    sum += size;
  }
  double travelled = 0;
  for (const double s : sizes) {
    travelled += s;
    edges.push_back(fine_end + rest * (travelled / sum));
  }
  edges.back() = to;
  return edges;
}

}  // namespace palpate::fem
