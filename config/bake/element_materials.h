// Which material each finite element of an elastic body has: body.material, and body.material_region where one is.
#pragma once

#include <vector>

#include "config/fem/large_strain_solver.h"
#include "config/fem/tet_mesh.h"
#include "config/scene/scene.h"

namespace palpate {

// Of each element, in the mesh's order; empty where the scene has one material. An element that a box or ball cuts has
// the mean of what is in it, by volume. Of regions that overlap the last counts. Throws ConfigError for a region
// without an element and for groups that the mesh does not have.
std::vector<fem::ElementMaterial> element_materials(const SceneDesc& scene, const TetMesh& mesh);

// Groups for the elements of a mesh of the same body: each has that of the element of `from` that its middle lies in.
void take_groups(const TetMesh& from, TetMesh& mesh);

}  // namespace palpate
