// Shape functions and quadrature of the quadratic elements, and the pressure modes that keep them free of locking.
#pragma once

#include <vector>

#include "config/fem/large_strain_mesh.h"

namespace palpate::fem {

// The volume change is projected, element by element, on these modes: linear for Q9 and H27 (the optimal pair of
// Simo, Taylor & Pister 1985), constant for T10.
template <int kDim>
struct ElementTables {
  int nodes = 0, points = 0, modes = 0;
  std::vector<double> weight;                  // [points]
  std::vector<double> shape;                   // [points][nodes]
  std::vector<Point<kDim>> gradient;           // [points][nodes], in parameters of the element
  std::vector<double> pressure;                // [points][modes]
  std::vector<Point<kDim>> gradient_at_nodes;  // [nodes][nodes]
};
template <int kDim>
ElementTables<kDim> element_tables(StrainElement element);

}  // namespace palpate::fem
