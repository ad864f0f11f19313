#include "config/fem/tet_numbering.h"

#include <map>

namespace palpate {

TetFile number_tets(const std::vector<std::int64_t>& node_number, const std::vector<Vec3>& node_m,
                    const std::vector<FileTet>& tets, std::int32_t other_elements,
                    const std::function<void(const std::string&)>& fail) {
  std::map<std::int64_t, std::size_t> place;
  for (std::size_t i = 0; i < node_number.size(); ++i)
    if (!place.try_emplace(node_number[i], i).second)
      fail("node " + std::to_string(node_number[i]) + " is given twice");
  std::vector<std::int32_t> index(node_m.size(), -1);
  for (std::size_t t = 0; t < tets.size(); ++t)
    for (std::size_t k = 0; k < static_cast<std::size_t>(tets[t].nodes); ++k) {
      const auto found = place.find(tets[t].number[k]);
      if (found == place.end())
        fail("tetrahedron " + std::to_string(t) + " (counted from 0) has the node " +
             std::to_string(tets[t].number[k]) + ", which the file does not hold");
      else
        index[found->second] = 0;
    }
  TetFile out;
  out.other_elements = other_elements;
  for (std::size_t i = 0; i < node_m.size(); ++i) {
    if (index[i] < 0) {
      ++out.unused_nodes;
      continue;
    }
    index[i] = static_cast<std::int32_t>(out.mesh.node_m.size());
    out.mesh.node_m.push_back(node_m[i]);
  }
  for (const FileTet& t : tets) {
    Tet tet;
    for (std::size_t k = 0; k < static_cast<std::size_t>(t.nodes); ++k) tet.node[k] = index[place.at(t.number[k])];
    out.mesh.tet.push_back(tet);
    out.mesh.group.push_back(t.group);
    if (t.group != 0) out.mesh.group_name.try_emplace(t.group);
  }
  if (out.mesh.group_name.empty()) out.mesh.group.clear();
  return out;
}

}  // namespace palpate
