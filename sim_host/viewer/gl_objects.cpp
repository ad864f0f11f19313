#include "sim_host/viewer/gl_objects.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace palpate {

namespace {

GLuint compile(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good != 0) return shader;
  char log[2000] = {};
  glGetShaderInfoLog(shader, sizeof log - 1, nullptr, log);
  throw std::runtime_error(std::string("the graphics driver refuses a shader: ") + log);
}

std::array<float, 3> floats(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

GlProgram::GlProgram(const char* vertex_source, const char* fragment_source) : program_(glCreateProgram()) {
  const GLuint vertex = compile(GL_VERTEX_SHADER, vertex_source);
  const GLuint fragment = compile(GL_FRAGMENT_SHADER, fragment_source);
  glAttachShader(program_, vertex);
  glAttachShader(program_, fragment);
  link();
  glDeleteShader(vertex);
  glDeleteShader(fragment);
}
GlProgram::GlProgram(const char* vertex_source, std::span<const char* const> kept, bool into_one)
    : program_(glCreateProgram()) {
  const GLuint vertex = compile(GL_VERTEX_SHADER, vertex_source);
  glAttachShader(program_, vertex);
  glTransformFeedbackVaryings(program_, static_cast<GLsizei>(kept.size()), kept.data(),
                              into_one ? GL_INTERLEAVED_ATTRIBS : GL_SEPARATE_ATTRIBS);
  link();
  glDeleteShader(vertex);
}
void GlProgram::link() const {
  glLinkProgram(program_);
  GLint good = 0;
  glGetProgramiv(program_, GL_LINK_STATUS, &good);
  if (good == 0) throw std::runtime_error("the graphics driver cannot link a shader");
}
GlProgram::~GlProgram() { glDeleteProgram(program_); }
void GlProgram::use() const { glUseProgram(program_); }
GLint GlProgram::place(const char* name) const { return glGetUniformLocation(program_, name); }
void GlProgram::set(const char* name, const Matrix4& value) const {
  glUniformMatrix4fv(place(name), 1, GL_FALSE, value.data());
}
void GlProgram::set(const char* name, Vec3 value) const { glUniform3fv(place(name), 1, floats(value).data()); }
void GlProgram::set(const char* name, Colour c, float opacity) const {
  glUniform4f(place(name), c.r, c.g, c.b, opacity);
}
void GlProgram::set(const char* name, float value) const { glUniform1f(place(name), value); }
void GlProgram::set(const char* name, int value) const { glUniform1i(place(name), value); }
void GlProgram::set(const char* name, std::span<const float> values) const {
  glUniform1fv(place(name), static_cast<GLsizei>(values.size()), values.data());
}

GlMesh::GlMesh() {
  glGenVertexArrays(1, &array_);
  glGenBuffers(1, &vertices_);
  glGenBuffers(1, &indices_);
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  const auto attribute = [](GLuint place, GLint numbers, std::size_t offset) {
    glEnableVertexAttribArray(place);
    glVertexAttribPointer(place, numbers, GL_FLOAT, GL_FALSE, sizeof(DrawnVertex),
                          reinterpret_cast<const void*>(offset));
  };
  attribute(0, 3, offsetof(DrawnVertex, position));
  attribute(1, 3, offsetof(DrawnVertex, normal));
  attribute(2, 2, offsetof(DrawnVertex, displacement_m));  // and pressure_Pa behind it
}
GlMesh::GlMesh(GlMesh&& other) noexcept
    : array_(std::exchange(other.array_, 0)),
      vertices_(std::exchange(other.vertices_, 0)),
      indices_(std::exchange(other.indices_, 0)),
      fewer_(std::exchange(other.fewer_, 0)),
      count_(other.count_),
      fewer_count_(other.fewer_count_),
      bytes_(other.bytes_) {}
GlMesh::~GlMesh() {
  if (array_ == 0) return;
  glDeleteVertexArrays(1, &array_);
  glDeleteBuffers(1, &vertices_);
  glDeleteBuffers(1, &indices_);
  if (fewer_ != 0) glDeleteBuffers(1, &fewer_);
}
void GlMesh::set_triangles(std::span<const std::array<std::uint32_t, 3>> triangles) {
  count_ = fill(indices_, triangles);
}
void GlMesh::set_fewer_triangles(std::span<const std::array<std::uint32_t, 3>> triangles) {
  if (fewer_ == 0) glGenBuffers(1, &fewer_);
  fewer_count_ = fill(fewer_, triangles);
}
GLsizei GlMesh::fill(GLuint indices, std::span<const std::array<std::uint32_t, 3>> triangles) const {
  glBindVertexArray(array_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size_bytes()), triangles.data(),
               GL_STATIC_DRAW);
  return static_cast<GLsizei>(3 * triangles.size());
}
void GlMesh::set_vertices(std::span<const DrawnVertex> vertices) {
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  const auto bytes = static_cast<GLsizeiptr>(vertices.size_bytes());
  if (bytes_ >= vertices.size_bytes()) return glBufferSubData(GL_ARRAY_BUFFER, 0, bytes, vertices.data());
  glBufferData(GL_ARRAY_BUFFER, bytes, vertices.data(), GL_STREAM_DRAW);
  bytes_ = vertices.size_bytes();
}
void GlMesh::draw(bool fewer) const {
  fewer = fewer && fewer_ != 0;
  glBindVertexArray(array_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, fewer ? fewer_ : indices_);
  glDrawElements(GL_TRIANGLES, fewer ? fewer_count_ : count_, GL_UNSIGNED_INT, nullptr);
}

GlTable::GlTable(GLenum format) {
  glGenBuffers(1, &buffer_);
  glGenTextures(1, &texture_);
  glBindBuffer(GL_TEXTURE_BUFFER, buffer_);
  glBindTexture(GL_TEXTURE_BUFFER, texture_);
  glTexBuffer(GL_TEXTURE_BUFFER, format, buffer_);
}
GlTable::~GlTable() {
  glDeleteTextures(1, &texture_);
  glDeleteBuffers(1, &buffer_);
}
void GlTable::set(const void* data, std::size_t bytes, GLenum use) {
  glBindBuffer(GL_TEXTURE_BUFFER, buffer_);
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes), data, use);
}
void GlTable::look_up(const GlProgram& program, const char* name, int unit) const {
  program.set(name, unit);
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_BUFFER, texture_);
  glActiveTexture(GL_TEXTURE0);
}

void keep_vertices(GLuint array, std::size_t count, std::initializer_list<GLuint> buffers) {
  GLuint place = 0;
  for (const GLuint buffer : buffers) glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, place++, buffer);
  glBindVertexArray(array);
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count));
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);
  while (place > 0) glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, --place, 0);
}

std::vector<std::array<std::uint32_t, 3>> indices_of(const RenderMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& [a, b, c] : mesh.triangle)
    triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  return triangles;
}

GlMesh gl_mesh(const RenderMesh& mesh) {
  std::vector<DrawnVertex> vertices;
  for (std::size_t i = 0; i < mesh.position_m.size(); ++i) {
    const auto p = floats(mesh.position_m[i]), n = floats(mesh.normal[i]);
    vertices.push_back({{p[0], p[1], p[2]}, {n[0], n[1], n[2]}, 0, 0});
  }
  GlMesh result;
  result.set_triangles(indices_of(mesh));
  result.set_vertices(vertices);
  return result;
}

void GlFramebuffer::release() {
  if (frame_ != 0) glDeleteFramebuffers(1, &frame_);
  if (texture_ != 0) glDeleteTextures(1, &texture_);
  if (colour_ != 0) glDeleteRenderbuffers(1, &colour_);
  if (depth_ != 0) glDeleteRenderbuffers(1, &depth_);
  frame_ = texture_ = colour_ = depth_ = 0;
}
GlFramebuffer::~GlFramebuffer() { release(); }

void GlFramebuffer::resize(int width, int height, int samples, GLenum format) {
  if (frame_ != 0 && width == width_ && height == height_ && samples == samples_) return;
  release();
  width_ = width;
  height_ = height;
  samples_ = samples;
  glGenFramebuffers(1, &frame_);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  if (samples > 1) {
    glGenRenderbuffers(1, &colour_);
    glBindRenderbuffer(GL_RENDERBUFFER, colour_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  } else {
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, format == GL_R8 ? GL_RED : GL_RGBA,
                 GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  }
  glGenRenderbuffers(1, &depth_);
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, GL_DEPTH_COMPONENT24, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the graphics driver gives no framebuffer of " + std::to_string(width) + " x " +
                             std::to_string(height) + " pixels with " + std::to_string(samples) + " samples");
}

void GlFramebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, width_, height_);
}

void GlFramebuffer::resolve_into(const GlFramebuffer& other) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, other.frame_);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

std::vector<std::uint8_t> GlFramebuffer::pixels() const {
  const std::size_t row = 3 * static_cast<std::size_t>(width_), rows = static_cast<std::size_t>(height_);
  std::vector<std::uint8_t> bottom_up(row * rows), top_down(row * rows);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, bottom_up.data());
  for (std::size_t y = 0; y < rows; ++y)
    std::copy_n(bottom_up.data() + (rows - 1 - y) * row, row, top_down.data() + y * row);
  return top_down;
}

void draw_whole_picture() {
  static GLuint array = 0;  // core profile draws nothing without one
  if (array == 0) glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

Matrix4 matrix_of(const Pose& pose) {
  const RigidFrame f(pose);
  const auto x = floats(f.x), y = floats(f.y), z = floats(f.z), o = floats(f.origin);
  return {x[0], x[1], x[2], 0, y[0], y[1], y[2], 0, z[0], z[1], z[2], 0, o[0], o[1], o[2], 1};
}

}  // namespace palpate
