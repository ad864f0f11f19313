// Draws body, tool, forces and floor of one tick with OpenGL. Numbers and labels are drawn over it by overlay.h.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sim_host/view/view_scales.h"
#include "sim_host/viewer/gl_objects.h"
#include "sim_host/viewer/shader_surface.h"

namespace palpate {

// What is to be seen; a person switches these.
struct ViewLayers {
  bool rest_outline = true, tool = true, device_ghost = true, forces = true, contacts = true, anchors = true;
  bool floor = true;
  SurfaceColour colour = SurfaceColour::kDisplacement;
  bool operator==(const ViewLayers&) const = default;
};

class SceneRenderer {
 public:
  // A context must be current; `maker` must outlive this.
  SceneRenderer(const Model& model, const FrameMaker& maker);
  // Takes the deformed surface; the frame must live until the next one. Returns the largest value of each colour.
  std::array<double, kSurfaceColours> show(const ViewFrame& frame);
  // Into `target`, which is resized; `samples` per pixel. `fewer`: a body of very many triangles is drawn coarser.
  void draw(const ViewFrame& frame, const OrbitCamera& camera, const ViewLayers& layers, const ColourScale& colours,
            const ForceScale& forces, GlFramebuffer& target, int samples, bool fewer);
  std::size_t fewer_triangles() const { return fewer_triangles_; }
  // How far the vertex shader's surface of the frame shown is from the reference, in full and as it is while it moves;
  // none where it is not evaluated there.
  std::optional<std::array<SurfaceDifference, 2>> from_reference();
  double floor_y_m() const { return floor_y_m_; }
  double size_m() const { return size_m_; }
  double grid_m() const { return grid_m_; }

 private:
  struct Look {
    Colour colour;
    float opacity, gloss, rim;
    float plain = 0;
  };
  void bring_surface(bool fewer);
  void set_view(const GlProgram& program) const;
  void draw_background(const ViewFrame& frame, bool floor);
  void draw_shadow(const ViewFrame& frame);
  void draw_body(const ColourScale& colours);
  void draw_piece(const ViewFrame& frame, std::size_t piece, const Pose& tool_w, const Look& look);
  void draw_tool(const ViewFrame& frame);
  void draw_ghost(const ViewFrame& frame);
  void draw_solid(const GlMesh& mesh, const Matrix4& place, const Look& look);
  void draw_arrow(Vec3 tail_w, Vec3 way_m, Colour colour, float opacity);
  void draw_forces(const ViewFrame& frame, const ForceScale& scale, float opacity);
  void draw_points(const ViewFrame& frame, const ViewLayers& layers, const ColourScale& colours);
  void draw_anchors(const AnchorField& field, const ColourScale& colours);
  void draw_beams(const State& state, const AnchorField& field, const ColourScale& colours, float opacity);
  Colour anchor_colour(const AnchorField& field, std::size_t anchor, const ColourScale& colours) const;
  void make_outline(int samples);
  void draw_outline(const GlFramebuffer& target, int samples);

  const Model& model_;
  const FrameMaker& maker_;
  bool is_hand_;
  double size_m_, floor_y_m_ = 0, grid_m_ = 0.01;
  Vec3 centre_m_;
  GlProgram body_program_, solid_program_, cover_program_, background_program_, blur_program_, outline_program_,
      lay_program_;
  std::optional<ShaderSurface> shader_;  // of an elastic body
  const ViewFrame* frame_ = nullptr;     // shown
  bool brought_ = false, brought_fewer_ = false, fewer_ = false;
  std::size_t fewer_triangles_ = 0, fewer_vertices_ = 0;
  GlMesh body_, rest_, ball_, shaft_, head_, beam_;
  std::vector<GlMesh> pieces_;  // tool frame, joints at zero
  GLuint colours_ = 0;
  GlFramebuffer scene_, mask_samples_, mask_, outline_, shadow_, soft_shadow_;
  bool shadowed_ = false;  // shadow_ is of frame_
  bool outlined_ = false;  // outline_ is of outlined_camera_
  Camera outlined_camera_;
  int outlined_samples_ = 0;
  // Of the picture being drawn.
  Camera camera_;
  Matrix4 projection_{};
  int width_ = 0, height_ = 0;
};

}  // namespace palpate
