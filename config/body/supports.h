// What holds a body: the entries of body.fixed, together. Without any, the base of FixedDesc's default.
#pragma once

#include <functional>
#include <string>

#include "config/fem/material.h"
#include "config/scene/scene.h"

namespace palpate {

// The regions that hold the body: the scene's, or the default base.
std::vector<FixedDesc> held_regions(const SceneDesc& scene);

// An elastic bed under the surface between the chosen nodes of a mesh of finite elements.
struct ElasticBed {
  std::vector<char> node;  // per node of the mesh
  double stiffness_N_per_m3 = 0;
  std::uint8_t components = kHoldAll;
  bool normal = false;  // along the surface's normal alone, whatever `components`
};

// Whether an entry's region, a base, box or ball, has point `x_w` of a body whose lowest point is at `lowest_m`.
bool in_region(const FixedDesc& entry, Vec3 x_w, double lowest_m);
// The same for all entries of the scene, whatever components they hold.
bool is_fixed(const SceneDesc& scene, Vec3 x_w, double lowest_m);

// Height of the base, for what knows only bodies that stand on it where their shape is made. Throws ConfigError for
// others, naming `who`.
double standing_base_m(const SceneDesc& scene, const std::string& who);

// What of the mesh is held: as the body's shape says, or by the scene's entries. Throws ConfigError when an entry holds
// no node, or when nothing is left to move; whether the body can still move as a whole is check_supports' to say.
Supports supports_of(const SceneDesc& scene, const TetMesh& mesh);
// The scene's elastic beds. Throws ConfigError when one has no triangle of the surface.
std::vector<ElasticBed> beds_of(const SceneDesc& scene, const TetMesh& mesh);
// What neither is free nor stands alone: rigid supports and beds, for what asks where tools cannot come.
Supports supports_and_beds(Supports supports, const std::vector<ElasticBed>& beds);

// Whether points of a body with this surface lie in an entry's region: of a patch within its radius of the surface's
// point nearest to its centre, of vertices on their triangles. Throws ConfigError.
std::function<bool(Vec3)> region_on(const SceneDesc& scene, std::size_t entry, const SurfaceMesh& surface);

}  // namespace palpate
