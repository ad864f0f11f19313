// A tetrahedral mesh whose elements may be linear (4 nodes), quadratic (10) or in between: every edge of a tetrahedron
// has a node in its middle or has none and stays straight (Zienkiewicz & Taylor 2005, section 4.8: hierarchical edges).
// An element with some middle nodes is the transition element between the linear and the quadratic part of a mesh
// (Duriez, Andriot & Kheddar 2003, section 3.2). Positions in metres, in the body's frame.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "config/body/mesh.h"

namespace palpate {

// Which two corners an edge joins: the order of C3D10 (Abaqus, CalculiX) and of VTK's quadratic tetrahedron.
inline constexpr std::array<std::array<std::int32_t, 2>, 6> kTetEdge{
    {{{0, 1}}, {{1, 2}}, {{2, 0}}, {{0, 3}}, {{1, 3}}, {{2, 3}}}};
// Corners of the face opposite corner f, counter-clockwise seen from outside.
inline constexpr std::array<std::array<std::int32_t, 3>, 4> kTetFace{
    {{{1, 2, 3}}, {{0, 3, 2}}, {{0, 1, 3}}, {{0, 2, 1}}}};
// Edge between two corners, as an index into kTetEdge.
std::size_t tet_edge(std::size_t corner_a, std::size_t corner_b);

// Nodes 0-3: corners, with (1-0) x (2-0) . (3-0) > 0. Node 4+e: the middle node of edge e, or -1.
struct Tet {
  std::array<std::int32_t, 10> node{-1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
  bool is_quadratic() const;
};

struct TetMesh {
  std::vector<Vec3> node_m;
  std::vector<Tet> tet;
  std::vector<std::int32_t> group = {};                 // of each element, 0: in none; empty: the file has none
  std::map<std::int32_t, std::string> group_name = {};  // "" where it has a number alone
};

// Volume of the corners' straight tetrahedron; negative when inverted. m^3
double corner_volume_m3(const TetMesh& mesh, const Tet& tet);

// Where the middle node of the edge between two nodes belongs, given the middle of the chord: `project` moves the
// middles of boundary edges onto a curved surface and leaves others alone. Gets the middle and the two end nodes.
using EdgeProjection = std::function<Vec3(Vec3 middle_m, std::int32_t node_a, std::int32_t node_b)>;

// Gives every edge of the chosen elements a middle node (an edge shared with other elements makes those transition
// elements). `wanted` holds one flag per element; empty means all. Existing middle nodes stay.
void add_middle_nodes(TetMesh& mesh, const std::vector<char>& wanted = {}, const EdgeProjection& project = {});

// Takes the middle nodes away that no edge of the chosen elements has; the nodes are numbered anew, in their order. The
// elements around the chosen ones are transition elements then. None chosen: a linear mesh.
void keep_middle_nodes(TetMesh& mesh, const std::vector<char>& wanted);

// Flags of the elements within `layers` layers of elements (neighbours by a shared node) of a node that `inside`
// accepts: the zone of contact and the band around it that p-refinement needs.
std::vector<char> elements_near(const TetMesh& mesh, const std::function<bool(Vec3)>& inside, std::int32_t layers);

// The boundary. Faces with middle nodes are split at them into 2, 3 or 4 flat triangles, so that every boundary node
// is a vertex: vertex i of `mesh` is node `node[i]`, in increasing order of node numbers.
struct TetSurface {
  SurfaceMesh mesh;
  std::vector<std::int32_t> node;
};
TetSurface surface_of(const TetMesh& mesh);

// Throws ConfigError, naming `label` and the offending element or node and what to do, unless: node numbers are in
// range, coordinates finite, no tetrahedron inverted, flat or repeated (curved ones checked at their integration points
// and corners), no node unused, no two nodes in the same place, edges agree about their middle node, faces shared by
// two elements at most, and the boundary is one closed manifold surface.
void check_tet_mesh(const TetMesh& mesh, const std::string& label);

}  // namespace palpate
