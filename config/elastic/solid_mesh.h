// From the tetrahedra of imported and procedural bodies to the mesh of the large-strain elements.
#pragma once

#include "config/fem/large_strain_mesh.h"
#include "config/fem/material.h"
#include "config/fem/tet_mesh.h"

namespace palpate::elastic {

// Both number an element's nodes alike. Throws ConfigError, naming `label`, unless every element is quadratic.
fem::StrainMesh<3> solid_mesh(const TetMesh& mesh, const std::string& label);
// [node * 3 + component]
std::vector<bool> fixed_components(const Supports& supports);

}  // namespace palpate::elastic
