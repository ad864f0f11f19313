#include "sim_host/viewer/shader_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "config/index.h"
#include "rt_core/contact/contact.h"
#include "rt_core/contact/elastic/drawn_shapes.h"
#include "sim_host/viewer/surface_shaders.h"

namespace palpate {

namespace {

using Float3 = std::array<float, 3>;
using Corners = std::array<std::int32_t, 3>;
using Texel = std::array<float, 4>;

struct PointAttributes {
  Float3 rest, normal;
  std::array<std::uint32_t, 3> base;
  Float3 share;
};
struct CornerAttributes {
  Float3 corner, rest;
  std::array<std::int32_t, 3> of;
};

Float3 floats(Vec3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
Texel texel(Vec3 v, double w) { return {floats(v)[0], floats(v)[1], floats(v)[2], static_cast<float>(w)}; }

void attribute(GLuint place, std::size_t stride, std::size_t offset, bool whole) {
  const auto* from = reinterpret_cast<const void*>(offset);
  glEnableVertexAttribArray(place);
  if (whole)
    glVertexAttribIPointer(place, 3, GL_INT, static_cast<GLsizei>(stride), from);
  else
    glVertexAttribPointer(place, 3, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride), from);
}

template <class Attributes>
void fill(GLuint& array, GLuint& buffer, const std::vector<Attributes>& data) {
  glGenVertexArrays(1, &array);
  glGenBuffers(1, &buffer);
  glBindVertexArray(array);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(Attributes) * data.size()), data.data(), GL_STATIC_DRAW);
}

// The shapes of the modes at the model's vertices, one texel each: soft terms, then linear modes.
std::vector<Texel> shapes_of(const Model& model) {
  const std::int32_t soft = elastic_layout::terms(model.params.elastic_soft);
  std::vector<Texel> shape;
  for (std::int32_t v = 0; v < model.sizes.n_vertex; ++v) {
    const float* block = elastic_layout::vertex_block(model, v);
    const float* drawn = drawn_shapes::at(model, v);
    for (std::int32_t t = 0; t < soft; ++t, block += elastic_layout::kTermFloats)
      shape.push_back({block[0], block[1], block[2], 0});
    for (std::int32_t k = 0; k < drawn_shapes::count(model); ++k, drawn += elastic_layout::kDrawnFloats)
      shape.push_back({drawn[0], drawn[1], drawn[2], 0});
  }
  return shape;
}

// Every point as a mean of the corners of the model's triangle that it lies in.
struct Shares {
  std::array<std::uint32_t, 3> vertex{};
  std::array<double, 3> share{};

  void add(const Shares& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(other.share[k] > 0)) continue;
      std::size_t place = 0;
      while (place < 2 && share[place] > 0 && vertex[place] != other.vertex[k]) ++place;
      vertex[place] = other.vertex[k];
      share[place] += 0.5 * other.share[k];
    }
  }
};

std::vector<Shares> shares_of(const Model& model, const RefinedBody& refined) {
  std::vector<Shares> shares;
  shares.reserve(refined.rest_m().size());
  for (std::int32_t v = 0; v < model.sizes.n_vertex; ++v)
    shares.push_back({{static_cast<std::uint32_t>(v), 0, 0}, {1, 0, 0}});
  for (const auto& [a, b] : refined.parents()) {
    Shares mean;
    mean.add(shares[at(a)]);
    mean.add(shares[at(b)]);
    shares.push_back(mean);
  }
  return shares;
}

// Of every point the other two corners of each triangle around it, one point after another.
struct Rings {
  std::vector<std::int32_t> first, pair;  // `first` counts pairs
  Rings(const std::vector<Corners>& triangle, std::size_t points) : first(points + 1), pair(6 * triangle.size()) {
    for (const Corners& t : triangle)
      for (const std::int32_t v : t) ++first[at(v) + 1];
    for (std::size_t i = 0; i < points; ++i) first[i + 1] += first[i];
    std::vector<std::int32_t> next(first.begin(), first.end() - 1);
    for (const Corners& t : triangle) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t place = 2 * at(next[at(t[k])]++);
        pair[place] = t[(k + 1) % 3];
        pair[place + 1] = t[(k + 2) % 3];
      }
    }
  }
};

constexpr const char* kDisplaced[] = {"displaced"};
constexpr const char* kPlaced[] = {"placed", "pressure"};
constexpr const char* kVertex[] = {"position", "normal", "displacement", "pressure"};  // DrawnVertex

}  // namespace

SurfaceDifference difference(std::span<const DrawnVertex> a, std::span<const DrawnVertex> b) {
  SurfaceDifference most;
  double largest_Pa = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    double apart = 0, turn = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      apart += std::pow(static_cast<double>(a[i].position[k]) - static_cast<double>(b[i].position[k]), 2);
      turn += std::pow(static_cast<double>(a[i].normal[k]) - static_cast<double>(b[i].normal[k]), 2);
    }
    most.position_m = std::max(most.position_m, std::sqrt(apart));
    most.normal_rad = std::max(most.normal_rad, 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(turn))));
    most.pressure = std::max(most.pressure, static_cast<double>(std::abs(a[i].pressure_Pa - b[i].pressure_Pa)));
    largest_Pa = std::max(largest_Pa, static_cast<double>(b[i].pressure_Pa));
  }
  if (largest_Pa > 0) most.pressure /= largest_Pa;
  return most;
}

bool ShaderSurface::can(const Model& model, std::size_t most_triangles) {
  if (method_of(model) != Method::kElastic) return false;
  GLint most_texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most_texels);
  const std::size_t triangles = std::max(most_triangles, model.triangle.size());
  const std::size_t terms = at(elastic_layout::terms(model.params.elastic_soft) + drawn_shapes::count(model));
  // Rings have three pairs for each triangle, in full and coarser, and one for each corner on a crease.
  return std::max(8 * triangles, terms * model.vertex_m.size()) < static_cast<std::size_t>(most_texels);
}

ShaderSurface::ShaderSurface(const Model& model, const RefinedBody& refined, const DrawnBody& drawn, int fewer_halvings)
    : modes_(shaders::kModes, kDisplaced, true),
      points_(shaders::kPoints, kPlaced, false),
      corners_(shaders::kCorners, kVertex, true),
      shapes_(GL_RGBA32F),
      amplitudes_(GL_R32F),
      carried_(GL_RGBA32F),
      dents_(GL_RGBA32F),
      placed_(GL_RGBA32F),
      pressure_(GL_R32F),
      ring_(GL_RG32I),
      base_(static_cast<std::int32_t>(model.sizes.n_vertex)),
      terms_(elastic_layout::terms(model.params.elastic_soft) + drawn_shapes::count(model)) {
  static_assert(offsetof(DrawnVertex, normal) == 12 && offsetof(DrawnVertex, displacement_m) == 24 &&
                sizeof(DrawnVertex) == 32);
  const std::vector<Texel> shape = shapes_of(model);
  shapes_.set(shape.data(), sizeof(Texel) * shape.size(), GL_STATIC_DRAW);
  carried_.set(nullptr, sizeof(Texel) * at(base_), GL_STREAM_COPY);
  placed_.set(nullptr, sizeof(Texel) * refined.rest_m().size(), GL_STREAM_COPY);
  pressure_.set(nullptr, sizeof(float) * refined.rest_m().size(), GL_STREAM_COPY);
  glGenVertexArrays(1, &nothing_);
  make_points(model, refined);
  std::vector<std::int32_t> ring;
  make_level(refined, drawn, 0, ring, level_[0]);
  if (fewer_halvings > 0) make_level(refined, drawn, fewer_halvings, ring, level_[1]);
  ring_.set(ring.data(), sizeof(std::int32_t) * ring.size(), GL_STATIC_DRAW);
}

ShaderSurface::~ShaderSurface() {
  const GLuint arrays[] = {nothing_, point_array_, level_[0].array, level_[1].array};
  const GLuint buffers[] = {point_buffer_, level_[0].buffer, level_[1].buffer};
  glDeleteVertexArrays(4, arrays);
  glDeleteBuffers(3, buffers);
}

void ShaderSurface::make_points(const Model& model, const RefinedBody& refined) {
  std::vector<PointAttributes> point;
  const std::vector<Shares> shares = shares_of(model, refined);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto& share = shares[i].share;
    point.push_back({floats(refined.rest_m()[i]), floats(refined.rest_normal()[i]), shares[i].vertex,
                     floats({share[0], share[1], share[2]})});
  }
  fill(point_array_, point_buffer_, point);
  attribute(0, sizeof(PointAttributes), offsetof(PointAttributes, rest), false);
  attribute(1, sizeof(PointAttributes), offsetof(PointAttributes, normal), false);
  attribute(2, sizeof(PointAttributes), offsetof(PointAttributes, base), true);
  attribute(3, sizeof(PointAttributes), offsetof(PointAttributes, share), false);
}

void ShaderSurface::make_level(const RefinedBody& refined, const DrawnBody& drawn, int halvings,
                               std::vector<std::int32_t>& ring, Level& level) {
  std::vector<Corners> triangle = refined.triangle();
  for (int i = 0; i < halvings; ++i) triangle = coarser(triangle);
  for (const Corners& t : triangle) level.points = std::max(level.points, at(*std::ranges::max_element(t)) + 1);
  const auto end =
      std::ranges::lower_bound(drawn.source, static_cast<std::int32_t>(level.points), {}, &DrawnBody::Source::vertex);
  level.vertices = static_cast<std::size_t>(end - drawn.source.begin());
  const std::vector<Vec3> normal = mesh_normals(refined.rest_m(), triangle);
  const Rings rings(triangle, level.points);
  const auto before = static_cast<std::int32_t>(ring.size() / 2);
  ring.insert(ring.end(), rings.pair.begin(), rings.pair.end());
  std::vector<CornerAttributes> vertex;
  for (std::size_t i = 0; i < level.vertices; ++i) {
    const DrawnBody::Source& s = drawn.source[i];
    const Vec3 corner = refined.corner_normal()[at(s.triangle)][at(s.corner)];
    const std::int32_t first = rings.first[at(s.vertex)], next = rings.first[at(s.vertex) + 1];
    CornerAttributes made{floats(corner), floats(normal[at(s.vertex)]), {s.vertex, before + first, next - first}};
    if (!RefinedBody::turns_with_point(corner, refined.rest_normal()[at(s.vertex)])) {
      const Corners& side = triangle[at(s.triangle) >> (2 * halvings)];
      const std::size_t k = static_cast<std::size_t>(std::ranges::find(side, s.vertex) - side.begin());
      made.rest = floats(face_normal(refined.rest_m(), side));
      made.of = {s.vertex, static_cast<std::int32_t>(ring.size() / 2), -1};
      ring.insert(ring.end(), {side[(k + 1) % 3], side[(k + 2) % 3]});
    }
    vertex.push_back(made);
  }
  fill(level.array, level.buffer, vertex);
  attribute(0, sizeof(CornerAttributes), offsetof(CornerAttributes, corner), false);
  attribute(1, sizeof(CornerAttributes), offsetof(CornerAttributes, rest), false);
  attribute(2, sizeof(CornerAttributes), offsetof(CornerAttributes, of), true);
}

void ShaderSurface::evaluate(const ElasticShape& shape, const GlMesh& body, bool fewer) {
  const Level& level = level_[fewer && level_[1].array != 0 ? 1 : 0];
  std::vector<float> amplitude;
  for (const double a : shape.soft) amplitude.push_back(static_cast<float>(a));
  for (const double a : shape.drawn) amplitude.push_back(static_cast<float>(a));
  amplitudes_.set(amplitude.data(), sizeof(float) * amplitude.size(), GL_STREAM_DRAW);
  modes_.use();
  modes_.set("terms", terms_);
  shapes_.look_up(modes_, "shapes", 0);
  amplitudes_.look_up(modes_, "amplitudes", 1);
  keep_vertices(nothing_, at(base_), {carried_.buffer()});

  std::vector<Texel> dent;
  for (const TipDent& d : shape.dent)
    dent.insert(dent.end(), {texel(d.foot_m, d.depth_m), texel(d.rest.inward, d.across_m),
                             texel(d.rest.along, d.along_m), texel({d.mean_Pa, d.edge_m, d.far_m}, d.drawn_in_m),
                             texel({d.spread_m, d.reach_m, d.ball_m}, d.bend_m), texel(d.now.inward, d.out_m),
                             texel(d.now.along, d.poisson_ratio)});
  has_dents_ = !dent.empty();
  if (has_dents_) dents_.set(dent.data(), sizeof(Texel) * dent.size(), GL_STREAM_DRAW);
  points_.use();
  points_.set("dents", static_cast<int>(shape.dent.size()));
  carried_.look_up(points_, "carried", 0);
  dents_.look_up(points_, "dent", 1);
  keep_vertices(point_array_, level.points, {placed_.buffer(), pressure_.buffer()});
  evaluated_ = level.points;

  corners_.use();
  placed_.look_up(corners_, "placed", 0);
  pressure_.look_up(corners_, "pressures", 1);
  ring_.look_up(corners_, "ring", 2);
  keep_vertices(level.array, level.vertices, {body.vertices()});
}

std::array<double, 2> ShaderSurface::largest() const {
  const auto most = [this](const GlTable& table, std::size_t stride) {
    glBindBuffer(GL_TEXTURE_BUFFER, table.buffer());
    const auto bytes = static_cast<GLsizeiptr>(sizeof(float) * stride * evaluated_);
    const auto* number = static_cast<const float*>(glMapBufferRange(GL_TEXTURE_BUFFER, 0, bytes, GL_MAP_READ_BIT));
    float largest = 0;
    for (std::size_t i = 0; number != nullptr && i < evaluated_; ++i)
      largest = std::max(largest, number[stride * i + stride - 1]);
    glUnmapBuffer(GL_TEXTURE_BUFFER);
    return static_cast<double>(largest);
  };
  return {most(placed_, 4), has_dents_ ? most(pressure_, 1) : 0.0};
}

std::vector<DrawnVertex> ShaderSurface::read_back(const GlMesh& body, std::size_t count) {
  std::vector<DrawnVertex> vertex(count);
  glBindBuffer(GL_ARRAY_BUFFER, body.vertices());
  glGetBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(sizeof(DrawnVertex) * vertex.size()), vertex.data());
  return vertex;
}

}  // namespace palpate
