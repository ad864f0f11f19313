// Meshes of the large-strain solver: quadratic elements only, because they need no special treatment in bending.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace palpate::fem {

template <int kDim>
using Point = std::array<double, static_cast<std::size_t>(kDim)>;

// Node order of kQ9 and kH27: tensor product, first coordinate fastest. kT10: vertices, then edges 01 12 20 03 13 23.
enum class StrainElement : std::uint8_t { kQ9, kH27, kT10 };

int nodes_per_element(StrainElement element);

template <int kDim>
struct StrainMesh {
  StrainElement element = kDim == 2 ? StrainElement::kQ9 : StrainElement::kH27;
  std::vector<Point<kDim>> nodes_m;
  std::vector<int> connectivity;

  int node_count() const { return static_cast<int>(nodes_m.size()); }
  int element_count() const { return static_cast<int>(connectivity.size()) / nodes_per_element(element); }
};

// A patch of Q9 elements between the element edges s[i] and t[j], carried to the plane by `map`; mid-side nodes are
// the images of the mid parameters. Edges that the map collapses to a point are allowed (triangular elements).
struct GridPatch {
  std::vector<double> s, t;
  std::function<Point<2>(double s, double t)> map;
};
// All patches, nodes closer than `weld_m` made one. Throws ConfigError when an element is turned inside out.
StrainMesh<2> make_plane_mesh(const std::vector<GridPatch>& patches, double weld_m);

// The plane mesh swept along z through the layers z[k]. `map` may bend the result.
StrainMesh<3> sweep(const StrainMesh<2>& plane, const std::vector<double>& z_m);

template <int kDim>
std::vector<int> nodes_where(const StrainMesh<kDim>& mesh, const std::function<bool(const Point<kDim>&)>& inside);

std::vector<double> uniform_steps(double from, double to, int count);
// From `from` to `to`: `fine_count` equal steps up to `fine_end`, then steps that grow by about `ratio`.
std::vector<double> graded_steps(double from, double fine_end, double to, int fine_count, double ratio);

}  // namespace palpate::fem
