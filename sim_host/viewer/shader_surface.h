// The surface of an elastic body, evaluated by the graphics driver's vertex shaders: modes, dents under the tips,
// normals. sim_host/view/deformed_surface.h is the reference, which exports and still pictures use; `palpate view
// --stats` says how far the two are apart.
#pragma once

#include <array>
#include <vector>

#include "sim_host/view/deformed_surface.h"
#include "sim_host/view/frame_maker.h"
#include "sim_host/viewer/gl_objects.h"

namespace palpate {

// How far a surface is from the reference.
struct SurfaceDifference {
  double position_m = 0, normal_rad = 0, pressure = 0;  // the last of the largest pressure
};
SurfaceDifference difference(std::span<const DrawnVertex> a, std::span<const DrawnVertex> b);

class ShaderSurface {
 public:
  // Whether the driver can: an elastic body, tables of that size. A context must be current.
  static bool can(const Model& model, std::size_t most_triangles);
  // `fewer_halvings`: how many times coarser the mesh of draw(true) is; 0: there is none.
  ShaderSurface(const Model& model, const RefinedBody& refined, const DrawnBody& drawn, int fewer_halvings);
  ~ShaderSurface();
  ShaderSurface(const ShaderSurface&) = delete;
  ShaderSurface& operator=(const ShaderSurface&) = delete;

  // Writes the vertices into `body`; `fewer`: those of the coarser mesh alone.
  void evaluate(const ElasticShape& shape, const GlMesh& body, bool fewer);
  // Of the last evaluate(): displacement (m) and pressure (Pa).
  std::array<double, 2> largest() const;
  // The first vertices in `body` now.
  static std::vector<DrawnVertex> read_back(const GlMesh& body, std::size_t count);

 private:
  // A mesh of the refined body.
  struct Level {
    std::size_t points = 0, vertices = 0;
    GLuint array = 0, buffer = 0;  // of CornerAttributes
  };
  void make_points(const Model& model, const RefinedBody& refined);
  void make_level(const RefinedBody& refined, const DrawnBody& drawn, int halvings, std::vector<std::int32_t>& ring,
                  Level& level);

  GlProgram modes_, points_, corners_;
  GlTable shapes_, amplitudes_, carried_, dents_, placed_, pressure_, ring_;
  GLuint nothing_ = 0, point_array_ = 0, point_buffer_ = 0;
  std::int32_t base_ = 0, terms_ = 0;
  std::array<Level, 2> level_;  // in full, fewer
  std::size_t evaluated_ = 0;   // points
  bool has_dents_ = false;
};

}  // namespace palpate
