// Points of a linear body whose strain a tick can watch cheaply: the ones that carry the largest strain when the
// surface is pressed somewhere. Near a press the mesh decides the strain of a nodal force; the pressure there,
// force / (area x E), is the local measure. Gauges see what happens away from it: bending, stretch, the foot of an arm.
#pragma once

#include <vector>

#include "config/fem/condense.h"
#include "config/fem/linear_body.h"

namespace palpate {

struct StrainGauges {
  std::vector<std::int32_t> tet;
  std::vector<Vec3> position_m;
  // Row-major: 3 n_vertex rows (vertex, axis of a unit force) of 6 n_gauge tensor components xx yy zz xy yz zx. 1/N
  std::vector<double> strain_1pN;
  // Of the largest strain that test presses make anywhere away from the press, the share that the gauges see.
  double mean_share = 0, worst_share = 0;
};

// Presses `kGaugePresses` places of the surface, spread evenly, and picks up to `count` of the most strained
// integration points so that together they see as much of each press's largest strain as possible.
inline constexpr std::size_t kGaugePresses = 96;
StrainGauges place_strain_gauges(const LinearBody& solver, const TetMesh& mesh, const CondensedBody& body,
                                 std::size_t count, const Progress& progress = {});

// sqrt(e : e) of six tensor components: the size of a strain, the same in every frame.
double strain_size(const double* components);

}  // namespace palpate
