#include "config/elastic/solid_mesh.h"

#include "config/scene/config_error.h"

namespace palpate::elastic {

fem::StrainMesh<3> solid_mesh(const TetMesh& mesh, const std::string& label) {
  fem::StrainMesh<3> out;
  out.element = fem::StrainElement::kT10;
  for (const Vec3 p : mesh.node_m) out.nodes_m.push_back({p.x, p.y, p.z});
  for (std::size_t t = 0; t < mesh.tet.size(); ++t) {
    if (!mesh.tet[t].is_quadratic())
      throw ConfigError(label + ": tetrahedron " + std::to_string(t) +
                        " is linear; an elastic body needs quadratic elements (linear ones bend too little)");
    out.connectivity.insert(out.connectivity.end(), mesh.tet[t].node.begin(), mesh.tet[t].node.end());
  }
  return out;
}

std::vector<bool> fixed_components(const Supports& supports) {
  std::vector<bool> fixed;
  for (const std::uint8_t held : supports)
    for (unsigned axis = 0; axis < 3; ++axis) fixed.push_back((held >> axis & 1U) != 0);
  return fixed;
}

}  // namespace palpate::elastic
