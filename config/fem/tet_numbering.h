// From the numbers a mesh file gives its nodes to consecutive ones, for the readers of mesh files.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "config/fem/tet_io.h"

namespace palpate {

struct FileTet {
  std::int32_t nodes = 4;               // 4 or 10
  std::array<std::int64_t, 10> number;  // of the nodes, in our order of edges
  std::int32_t group = 0;
};

// Keeps the nodes that tetrahedra use, in the file's order. Calls `fail`, which throws, with what is wrong: a node
// number given twice, an element with a node that the file does not hold.
TetFile number_tets(const std::vector<std::int64_t>& node_number, const std::vector<Vec3>& node_m,
                    const std::vector<FileTet>& tets, std::int32_t other_elements,
                    const std::function<void(const std::string&)>& fail);

}  // namespace palpate
