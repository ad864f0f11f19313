// What is owned on the graphics card: programs, vertex arrays, framebuffers. OpenGL 3.3 core; a context must be
// current.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "sim_host/view/frame_maker.h"
#include "sim_host/view/orbit_camera.h"

namespace palpate {

class GlProgram {
 public:
  // Throws std::runtime_error with the compiler's text.
  GlProgram(const char* vertex_source, const char* fragment_source);
  // A vertex shader alone, whose outputs `kept` go into buffers: all into one, or one into each.
  GlProgram(const char* vertex_source, std::span<const char* const> kept, bool into_one);
  ~GlProgram();
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;
  void use() const;
  void set(const char* name, const Matrix4& value) const;
  void set(const char* name, Vec3 value) const;
  void set(const char* name, Colour colour, float opacity) const;
  void set(const char* name, float value) const;
  void set(const char* name, int value) const;
  void set(const char* name, std::span<const float> values) const;

 private:
  GLint place(const char* name) const;
  void link() const;
  GLuint program_ = 0;
};

// Triangles of DrawnVertex.
class GlMesh {
 public:
  GlMesh();
  ~GlMesh();
  GlMesh(GlMesh&& other) noexcept;
  GlMesh(const GlMesh&) = delete;
  GlMesh& operator=(const GlMesh&) = delete;
  void set_triangles(std::span<const std::array<std::uint32_t, 3>> triangles);
  // Fewer triangles of the same vertices, for draw(true).
  void set_fewer_triangles(std::span<const std::array<std::uint32_t, 3>> triangles);
  // The first of them alone, where there are more already.
  void set_vertices(std::span<const DrawnVertex> vertices);
  void draw(bool fewer = false) const;
  GLuint vertices() const { return vertices_; }

 private:
  // Returns how many indices there are.
  GLsizei fill(GLuint indices, std::span<const std::array<std::uint32_t, 3>> triangles) const;
  GLuint array_ = 0, vertices_ = 0, indices_ = 0, fewer_ = 0;
  GLsizei count_ = 0, fewer_count_ = 0;
  std::size_t bytes_ = 0;
};
std::vector<std::array<std::uint32_t, 3>> indices_of(const RenderMesh& mesh);
GlMesh gl_mesh(const RenderMesh& mesh);

// Numbers that a shader looks up by index, or that one keeps for another.
class GlTable {
 public:
  // `format`: of a texel, GL_RGBA32F and such.
  explicit GlTable(GLenum format);
  ~GlTable();
  GlTable(const GlTable&) = delete;
  GlTable& operator=(const GlTable&) = delete;
  // Null `data`: room for it.
  void set(const void* data, std::size_t bytes, GLenum use);
  void look_up(const GlProgram& program, const char* name, int unit) const;
  GLuint buffer() const { return buffer_; }

 private:
  GLuint buffer_ = 0, texture_ = 0;
};

// Runs the vertex shader in use for `count` vertices of `array`, and keeps what it says in the buffers.
void keep_vertices(GLuint array, std::size_t count, std::initializer_list<GLuint> buffers);

// Colour and depth; with samples > 1 it must be resolved into one without before it can be read.
class GlFramebuffer {
 public:
  GlFramebuffer() = default;
  ~GlFramebuffer();
  GlFramebuffer(const GlFramebuffer&) = delete;
  GlFramebuffer& operator=(const GlFramebuffer&) = delete;
  // Made anew when the size differs. `format`: GL_RGBA8 or GL_R8.
  void resize(int width, int height, int samples, GLenum format);
  void bind() const;
  void resolve_into(const GlFramebuffer& other) const;
  GLuint id() const { return frame_; }
  GLuint texture() const { return texture_; }
  int width() const { return width_; }
  int height() const { return height_; }
  // RGB rows from the top.
  std::vector<std::uint8_t> pixels() const;

  void release();

 private:
  GLuint frame_ = 0, texture_ = 0, colour_ = 0, depth_ = 0;
  int width_ = 0, height_ = 0, samples_ = 0;
};

// Three vertices that cover the picture, made in the vertex shader.
void draw_whole_picture();

Matrix4 matrix_of(const Pose& pose);

}  // namespace palpate
