#include "config/fem/large_strain_elements.h"

#include <cmath>

namespace palpate::fem {

namespace {

struct Lagrange3 {
  std::array<double, 3> value, slope;
};
Lagrange3 lagrange3(double x) {
  return {{0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)}, {x - 0.5, -2 * x, x + 0.5}};
}

std::size_t digit(int i, int axis) {
  return static_cast<std::size_t>(axis == 0 ? i % 3 : axis == 1 ? i / 3 % 3 : i / 9);
}

// Appends value and gradient of every node's tensor-product parabola on [-1, 1].
template <int kDim>
void append_tensor(const Point<kDim>& at, int nodes, std::vector<double>* shape, std::vector<Point<kDim>>& gradient) {
  for (int a = 0; a < nodes; ++a) {
    double n = 1;
    Point<kDim> grad;
    grad.fill(1);
    for (int d = 0; d < kDim; ++d) {
      const Lagrange3 l = lagrange3(at[static_cast<std::size_t>(d)]);
      n *= l.value[digit(a, d)];
      for (int e = 0; e < kDim; ++e)
        grad[static_cast<std::size_t>(e)] *= e == d ? l.slope[digit(a, d)] : l.value[digit(a, d)];
    }
    if (shape != nullptr) shape->push_back(n);
    gradient.push_back(grad);
  }
}

// Q9 and H27: 3 Gauss points each way.
template <int kDim>
ElementTables<kDim> tensor_tables() {
  ElementTables<kDim> t;
  const std::array<double, 3> place = {-std::sqrt(0.6), 0.0, std::sqrt(0.6)};
  const std::array<double, 3> weight = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  t.nodes = t.points = kDim == 2 ? 9 : 27;
  t.modes = kDim + 1;
  for (int g = 0; g < t.points; ++g) {
    Point<kDim> point, node;
    double w = 1;
    t.pressure.push_back(1);
    for (int d = 0; d < kDim; ++d) {
      point[static_cast<std::size_t>(d)] = place[digit(g, d)];
      node[static_cast<std::size_t>(d)] = static_cast<double>(digit(g, d)) - 1;
      w *= weight[digit(g, d)];
      t.pressure.push_back(place[digit(g, d)]);
    }
    t.weight.push_back(w);
    append_tensor<kDim>(point, t.nodes, &t.shape, t.gradient);
    append_tensor<kDim>(node, t.nodes, nullptr, t.gradient_at_nodes);
  }
  return t;
}

constexpr int kTetEdge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

void append_tetrahedron(const double (&l)[4], std::vector<double>* shape, std::vector<Point<3>>& gradient) {
  constexpr double kSlope[4][3] = {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 4; ++i) {
    if (shape != nullptr) shape->push_back(l[i] * (2 * l[i] - 1));
    const double s = 4 * l[i] - 1;
    gradient.push_back({s * kSlope[i][0], s * kSlope[i][1], s * kSlope[i][2]});
  }
  for (const auto& e : kTetEdge) {
    if (shape != nullptr) shape->push_back(4 * l[e[0]] * l[e[1]]);
    Point<3> grad;
    for (std::size_t d = 0; d < 3; ++d) grad[d] = 4 * (l[e[0]] * kSlope[e[1]][d] + l[e[1]] * kSlope[e[0]][d]);
    gradient.push_back(grad);
  }
}

ElementTables<3> tetrahedron_tables() {
  ElementTables<3> t;
  t.nodes = 10;
  t.points = 4;
  t.modes = 1;
  const double a = (5 + 3 * std::sqrt(5.0)) / 20, b = (5 - std::sqrt(5.0)) / 20;
  for (int g = 0; g < 4; ++g) {
    double l[4];
    for (int i = 0; i < 4; ++i) l[i] = i == (g + 1) % 4 ? a : b;
    t.weight.push_back(1.0 / 24);
    t.pressure.push_back(1);
    append_tetrahedron(l, &t.shape, t.gradient);
  }
  for (int n = 0; n < 10; ++n) {
    double l[4] = {};
    if (n < 4)
      l[n] = 1;
    else
      l[kTetEdge[n - 4][0]] = l[kTetEdge[n - 4][1]] = 0.5;
    append_tetrahedron(l, nullptr, t.gradient_at_nodes);
  }
  return t;
}

}  // namespace

template <>
ElementTables<2> element_tables<2>(StrainElement) {
  return tensor_tables<2>();
}
template <>
ElementTables<3> element_tables<3>(StrainElement element) {
  return element == StrainElement::kT10 ? tetrahedron_tables() : tensor_tables<3>();
}

}  // namespace palpate::fem
