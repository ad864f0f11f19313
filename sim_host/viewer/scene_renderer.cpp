#include "sim_host/viewer/scene_renderer.h"

#include <algorithm>
#include <cmath>

#include "config/hand/hand_model.h"
#include "rt_core/tool/articulate.h"
#include "sim_host/view/anchors.h"
#include "sim_host/view/picture.h"
#include "sim_host/viewer/shaders.h"
#include "sim_host/viewer/theme.h"

namespace palpate {

namespace {

constexpr int kShadowPixels = 256;
// A body of more triangles than this is drawn with fewer while it moves.
constexpr std::size_t kMovingTriangles = 20'000;
constexpr double kShadowReach = 1.3;  // half the shadow's side, in extents of the body

constexpr Matrix4 kUnmoved{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix4 scaled(const Pose& pose, double across, double along) {
  Matrix4 m = matrix_of(pose);
  for (std::size_t i = 0; i < 12; ++i) m[i] *= static_cast<float>(i < 8 ? across : along);
  return m;
}

GLuint colour_texture() {
  constexpr int kColours = 256;
  std::vector<float> colours;
  for (int i = 0; i < kColours; ++i) {
    const Colour c = map_colour((i + 0.5) / kColours);
    colours.insert(colours.end(), {c.r, c.g, c.b});
  }
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB16F, kColours, 1, 0, GL_RGB, GL_FLOAT, colours.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  return texture;
}

// A dot of a few pixels: of a sphere's 5,000 triangles for pictures, twenty anchors would be most of a scene.
GlMesh unit_ball() {
  constexpr int kRings = 10, kSectors = 16;
  RenderMesh ball;
  for (int i = 0; i <= kRings; ++i) {
    const double polar = kPi * i / kRings;
    for (int j = 0; j < kSectors; ++j) {
      const double turn = 2 * kPi * j / kSectors;
      ball.position_m.push_back({std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)});
    }
  }
  const auto id = [](int i, int j) { return static_cast<std::int32_t>(i * kSectors + j % kSectors); };
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) {
      ball.triangle.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      ball.triangle.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  ball.normal = ball.position_m;
  return gl_mesh(ball);
}

// Of unit length and radius, along z: stretched where they are drawn.
GlMesh unit_shaft() {
  const Point2 profile[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  return gl_mesh(revolved_mesh({}, profile, 0));
}
// As thin as a beam is drawn, six sides are round.
GlMesh unit_beam() {
  constexpr int kSides = 6;
  RenderMesh beam;
  for (const double z : {0.0, 1.0}) {
    for (int j = 0; j < kSides; ++j) {
      const double turn = 2 * kPi * j / kSides;
      beam.normal.push_back({std::cos(turn), std::sin(turn), 0});
      beam.position_m.push_back(beam.normal.back() + Vec3{0, 0, z});
    }
  }
  for (std::int32_t j = 0; j < kSides; ++j) {
    const std::int32_t next = (j + 1) % kSides;
    beam.triangle.push_back({j, next, kSides + next});
    beam.triangle.push_back({j, kSides + next, kSides + j});
  }
  return gl_mesh(beam);
}
GlMesh unit_head() {
  const Point2 profile[] = {{0, 0}, {1, 0}, {0, 1}};
  return gl_mesh(revolved_mesh({}, profile, 0));
}

// Smooth all over, and so round at its rim, too; as it came while it moves.
GlMesh rounded_mesh(RenderMesh mesh) {
  std::vector<std::array<Vec3, 3>> corner;
  for (const auto& [a, b, c] : mesh.triangle)
    corner.push_back({mesh.normal[static_cast<std::size_t>(a)], mesh.normal[static_cast<std::size_t>(b)],
                      mesh.normal[static_cast<std::size_t>(c)]});
  std::vector<std::pair<std::int32_t, std::int32_t>> parents;
  const std::vector<std::array<std::uint32_t, 3>> fewer = indices_of(mesh);
  refine(mesh.position_m, mesh.triangle, corner, parents);
  for (const auto& [a, b] : parents) {
    const Vec3 n = mesh.normal[static_cast<std::size_t>(a)];
    mesh.normal.push_back(unit_or(n + mesh.normal[static_cast<std::size_t>(b)], n));
  }
  GlMesh result = gl_mesh(mesh);
  result.set_fewer_triangles(fewer);
  return result;
}

}  // namespace

SceneRenderer::SceneRenderer(const Model& model, const FrameMaker& maker)
    : model_(model),
      maker_(maker),
      is_hand_(model.params.articulation == Articulation::kHand),
      size_m_(model.params.surface_size_m),
      body_program_(shaders::kMesh, shaders::kBody),
      solid_program_(shaders::kMesh, shaders::kSolid),
      cover_program_(shaders::kMesh, shaders::kCover),
      background_program_(shaders::kWhole, shaders::kBackground),
      blur_program_(shaders::kWhole, shaders::kBlur),
      outline_program_(shaders::kWhole, shaders::kOutline),
      lay_program_(shaders::kWhole, shaders::kLay),
      ball_(unit_ball()),
      shaft_(unit_shaft()),
      head_(unit_head()),
      beam_(unit_beam()),
      colours_(colour_texture()) {
  std::vector<std::array<std::uint32_t, 3>> triangle = maker.body().triangle;
  for (GlMesh* mesh : {&body_, &rest_}) {
    mesh->set_triangles(triangle);
    mesh->set_vertices(maker.at_rest());
  }
  int halvings = 0;
  for (; halvings < maker.refined().halvings() && triangle.size() > kMovingTriangles; ++halvings)
    triangle = coarser(triangle);
  fewer_triangles_ = triangle.size();
  if (halvings > 0) {
    for (const auto& t : triangle)
      fewer_vertices_ = std::max<std::size_t>(fewer_vertices_, *std::ranges::max_element(t) + 1);
    body_.set_fewer_triangles(triangle);
    rest_.set_fewer_triangles(triangle);
  }
  if (maker.in_shader()) shader_.emplace(model, maker.refined(), maker.body(), halvings);
  for (const ToolPiece& piece : model.piece)
    pieces_.push_back(is_hand_ ? rounded_mesh(hand_render_mesh(piece, {}, is_left_hand(model)))
                               : gl_mesh(piece_mesh(model, piece, {})));
  floor_y_m_ = 1e30;
  Vec3 low{1e30, 1e30, 1e30}, high = -low;
  for (const Vec3 v : model.vertex_m) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  centre_m_ = 0.5 * (low + high);
  floor_y_m_ = low.y;
  grid_m_ = round_below(0.25 * size_m_);
}

std::array<double, kSurfaceColours> SceneRenderer::show(const ViewFrame& frame) {
  frame_ = &frame;
  brought_ = brought_fewer_ = shadowed_ = false;
  std::array<double, kSurfaceColours> largest = frame.largest;
  if (!shader_) return largest;
  bring_surface(true);
  const auto [displacement_m, pressure_Pa] = shader_->largest();
  largest[static_cast<std::size_t>(SurfaceColour::kDisplacement)] = displacement_m;
  largest[static_cast<std::size_t>(SurfaceColour::kPressure)] = pressure_Pa;
  return largest;
}

// Only what is drawn: of a million triangles that move, the coarser mesh.
void SceneRenderer::bring_surface(bool fewer) {
  fewer = fewer && fewer_vertices_ > 0;
  if (brought_ || (fewer && brought_fewer_)) return;
  if (shader_)
    shader_->evaluate(*frame_->elastic, body_, fewer);
  else
    body_.set_vertices(std::span(frame_->vertex).first(fewer ? fewer_vertices_ : frame_->vertex.size()));
  (fewer ? brought_fewer_ : brought_) = true;
}

std::optional<std::array<SurfaceDifference, 2>> SceneRenderer::from_reference() {
  if (!shader_ || frame_ == nullptr) return {};
  const std::vector<DrawnVertex> reference = drawn_vertices(maker_.body(), maker_.refined().shape(*frame_->state));
  std::array<SurfaceDifference, 2> apart;
  for (const bool fewer : {true, false}) {
    const std::size_t count = fewer && fewer_vertices_ > 0 ? fewer_vertices_ : reference.size();
    shader_->evaluate(*frame_->elastic, body_, fewer);
    apart[fewer ? 1 : 0] = difference(shader_->read_back(body_, count), std::span(reference).first(count));
  }
  brought_ = true;
  return apart;
}

void SceneRenderer::set_view(const GlProgram& program) const {
  const Projection axes(camera_, width_, height_);
  program.use();
  program.set("projection", projection_);
  program.set("eye", axes.eye());
  program.set("right", axes.right());
  program.set("up", axes.up());
  program.set("back", -axes.forward());
}

void SceneRenderer::draw_solid(const GlMesh& mesh, const Matrix4& place, const Look& look) {
  solid_program_.set("place", place);
  solid_program_.set("paint", look.colour, look.opacity);
  solid_program_.set("gloss", look.gloss);
  solid_program_.set("rim", look.rim);
  solid_program_.set("plain", look.plain);
  mesh.draw(fewer_);
}

// A view of body and tool from straight above, softened.
void SceneRenderer::draw_shadow(const ViewFrame& frame) {
  if (shadowed_) return;
  shadowed_ = true;
  shadow_.resize(kShadowPixels, kShadowPixels, 1, GL_R8);
  shadow_.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  cover_program_.use();
  const auto half = static_cast<float>(kShadowReach * size_m_);
  const auto x = static_cast<float>(centre_m_.x), z = static_cast<float>(centre_m_.z);
  // World x to the texture's u, world z to its v; height is dropped.
  const Matrix4 above{1 / half, 0, 0, 0, 0, 0, 0, 0, 0, 1 / half, 0, 0, -x / half, -z / half, 0, 1};
  cover_program_.set("projection", above);
  cover_program_.set("place", kUnmoved);
  body_.draw(true);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    cover_program_.set("place", matrix_of(carrier_w(model_, *frame.state, static_cast<std::int32_t>(i))));
    pieces_[i].draw(true);
  }
  glBindTexture(GL_TEXTURE_2D, shadow_.texture());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  soft_shadow_.resize(kShadowPixels / 2, kShadowPixels / 2, 1, GL_R8);
  soft_shadow_.bind();
  blur_program_.use();
  blur_program_.set("shadow", 0);
  draw_whole_picture();
}

void SceneRenderer::draw_background(const ViewFrame& frame, bool floor) {
  if (floor) draw_shadow(frame);
  scene_.bind();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  set_view(background_program_);
  background_program_.set("centre", centre_m_);
  background_program_.set("slope", static_cast<float>(std::tan(0.5 * camera_.vertical_fov_rad)));
  background_program_.set("aspect", static_cast<float>(width_) / static_cast<float>(height_));
  background_program_.set("floor_y", floor ? static_cast<float>(floor_y_m_) : -1e9f);
  background_program_.set("half_size", static_cast<float>(kShadowReach * size_m_));
  background_program_.set("grid", static_cast<float>(grid_m_));
  background_program_.set("shadow", 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, floor ? soft_shadow_.texture() : colours_);
  draw_whole_picture();
}

void SceneRenderer::draw_body(const ColourScale& colours) {
  set_view(body_program_);
  body_program_.set("place", kUnmoved);
  const bool on_surface = colours.shown != SurfaceColour::kStress && solves(model_, colours.shown);
  body_program_.set("bare", kNoValue, on_surface ? 0.0f : 1.0f);
  body_program_.set("pressed", colours.shown == SurfaceColour::kPressure ? 1.0f : 0.0f);
  body_program_.set("top", static_cast<float>(colours.top));
  std::vector<float> ticks;
  for (const double tick : colours.tick) ticks.push_back(static_cast<float>(tick * colours.unit));
  ticks.resize(std::min<std::size_t>(ticks.size(), 12));
  body_program_.set("tick", ticks);
  body_program_.set("ticks", static_cast<int>(ticks.size()));
  body_program_.set("colours", 0);
  glBindTexture(GL_TEXTURE_2D, colours_);
  body_.draw(fewer_);
}

void SceneRenderer::draw_piece(const ViewFrame& frame, std::size_t piece, const Pose& tool_w, const Look& look) {
  const Pose at = carrier_at(model_, *frame.state, tool_w, static_cast<std::int32_t>(piece));
  draw_solid(pieces_[piece], matrix_of(at), look);
}

// Glass, denser at its rim and faint behind the body; a hand is skin.
void SceneRenderer::draw_tool(const ViewFrame& frame) {
  const Pose tool_w = frame.state->tool_w;
  const auto all = [&](const Look& look) {
    for (std::size_t i = 0; i < pieces_.size(); ++i) draw_piece(frame, i, tool_w, look);
  };
  glDepthMask(GL_FALSE);
  glEnable(GL_CULL_FACE);
  glDepthFunc(GL_GREATER);
  all(is_hand_ ? Look{theme::kSkin, 0.07f, 0.05f, 0} : Look{theme::kTool, 0.10f, 0, 0.25f});
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  // Depth alone first: of glass, too, only what lies nearest is seen, not its parts through one another.
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  all({theme::kTool, 1, 0, 0});
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  all(is_hand_ ? Look{theme::kSkin, 1.0f, 0.08f, 0} : Look{theme::kTool, 0.34f, 0.5f, 0.55f});
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
}

// Where the handle stands: the virtual tool stays on the surface, the handle goes on.
void SceneRenderer::draw_ghost(const ViewFrame& frame) {
  const State& state = *frame.state;
  // Nearer than this the two cover one another.
  if (norm(state.device_w.position_m - state.tool_w.position_m) < 2e-4) return;
  glDepthMask(GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    draw_piece(frame, i, state.device_w, {theme::kGhost, 0.03f, 0, 0.42f});
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
}

void SceneRenderer::draw_arrow(Vec3 tail_w, Vec3 way_m, Colour colour, float opacity) {
  const double length = norm(way_m);
  if (!(length > 1e-6)) return;
  const double radius = 0.0085 * size_m_, head = std::min(0.55 * length, 4.6 * radius);
  const Pose pose{tail_w, rotation_between({0, 0, 1}, unit_or(way_m, {0, 0, 1}))};
  const Pose tip{tail_w + ((length - head) / length) * way_m, pose.orientation};
  const Look look{colour, opacity, 0.15f, 0, 0.6f};
  draw_solid(shaft_, scaled(pose, radius, length - head), look);
  draw_solid(head_, scaled(tip, 2.1 * radius, head), look);
}

void SceneRenderer::draw_forces(const ViewFrame& frame, const ForceScale& scale, float opacity) {
  for (const DrawnForce& force : drawn_forces(*frame.state)) {
    draw_arrow(force.tail_w, scale.m_per_N * force.force_N, theme::kForce, opacity);
    if (norm(force.friction_N) > 0.04 * norm(force.force_N))
      draw_arrow(force.tail_w, scale.m_per_N * force.friction_N, theme::kFriction, opacity);
  }
}

Colour SceneRenderer::anchor_colour(const AnchorField& field, std::size_t anchor, const ColourScale& colours) const {
  if (colours.shown == SurfaceColour::kStress) return map_colour(field.anchor[anchor].stress_Pa / colours.top);
  return model_.anchor[anchor].fixed != 0 ? theme::kFixed : theme::kAnchor;
}

void SceneRenderer::draw_anchors(const AnchorField& field, const ColourScale& colours) {
  const double radius = (colours.shown == SurfaceColour::kStress ? 0.018 : 0.012) * size_m_;
  for (std::size_t k = 0; k < model_.anchor.size(); ++k) {
    const Anchor& anchor = model_.anchor[k];
    const Vec3 at = anchor.position_m + (anchor.fixed != 0 ? Vec3{} : field.anchor[k].displacement_w);
    draw_solid(ball_, scaled({at, {}}, radius, radius), {anchor_colour(field, k, colours), 1, 0.3f, 0});
  }
}

// From where each region's contact is to every anchor: straight beams as they are, circular ones by their chords. Those
// of many regions, as of a hand's, are fainter, so that the body stays in sight.
void SceneRenderer::draw_beams(const State& state, const AnchorField& field, const ColourScale& colours,
                               float opacity) {
  const int regions = force_sum(state).regions;
  opacity *= std::min(1.0f, 2.0f / static_cast<float>(std::max(regions, 1)));
  for (const Region& region : state.region) {
    if (region.id == 0 || region.lost_ticks > 0) continue;
    for (std::size_t k = 0; k < model_.anchor.size(); ++k) {
      const Anchor& anchor = model_.anchor[k];
      const Vec3 end = anchor.position_m + (anchor.fixed != 0 ? Vec3{} : field.anchor[k].displacement_w);
      const Vec3 way = end - region.centre_w;
      const Pose pose{region.centre_w, rotation_between({0, 0, 1}, unit_or(way, {0, 0, 1}))};
      draw_solid(beam_, scaled(pose, 0.0035 * size_m_, norm(way)),
                 {anchor_colour(field, k, colours), opacity, 0.1f, 0, 0.5f});
    }
  }
}

void SceneRenderer::draw_points(const ViewFrame& frame, const ViewLayers& layers, const ColourScale& colours) {
  const State& state = *frame.state;
  if (layers.anchors && !model_.anchor.empty()) {
    const AnchorField field = anchors_of(model_, state);
    draw_anchors(field, colours);
    if (field.count > 0) {
      glEnable(GL_BLEND);
      glDepthMask(GL_FALSE);
      glDepthFunc(GL_GREATER);  // within the body, seen through it
      draw_beams(state, field, colours, 0.45f);
      glDepthMask(GL_TRUE);
      glDepthFunc(GL_LESS);
      draw_beams(state, field, colours, 1);
      glDisable(GL_BLEND);
    }
  }
  if (!layers.contacts) return;
  const double radius = 0.007 * size_m_;
  for (const Region& region : state.region) {
    if (region.id == 0 || region.lost_ticks > 0) continue;
    draw_solid(ball_, scaled({region.centre_w, {}}, 1.5 * radius, 1.5 * radius), {theme::kForce, 1, 0.3f, 0});
  }
}

void SceneRenderer::make_outline(int samples) {
  const Camera& old = outlined_camera_;
  const bool same = outlined_ && old.eye_m == camera_.eye_m && old.target_m == camera_.target_m &&
                    outlined_samples_ == samples && outline_.width() == width_ && outline_.height() == height_;
  if (same) return;
  outlined_ = true;
  outlined_camera_ = camera_;
  outlined_samples_ = samples;
  mask_samples_.resize(width_, height_, samples, GL_R8);
  mask_.resize(width_, height_, 1, GL_R8);
  outline_.resize(width_, height_, 1, GL_R8);
  mask_samples_.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  cover_program_.use();
  cover_program_.set("projection", projection_);
  cover_program_.set("place", kUnmoved);
  rest_.draw(fewer_);
  mask_samples_.resolve_into(mask_);
  outline_.bind();
  outline_program_.use();
  outline_program_.set("mask", 0);
  outline_program_.set("thick", height_ > 1400 ? 2.0f : 1.0f);
  glBindTexture(GL_TEXTURE_2D, mask_.texture());
  draw_whole_picture();
}

void SceneRenderer::draw_outline(const GlFramebuffer& target, int samples) {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  make_outline(samples);
  target.bind();
  glEnable(GL_BLEND);
  lay_program_.use();
  lay_program_.set("outline", 0);
  glBindTexture(GL_TEXTURE_2D, outline_.texture());
  draw_whole_picture();
  glDisable(GL_BLEND);
}

void SceneRenderer::draw(const ViewFrame& frame, const OrbitCamera& camera, const ViewLayers& layers,
                         const ColourScale& colours, const ForceScale& forces, GlFramebuffer& target, int samples,
                         bool fewer) {
  fewer_ = fewer;
  bring_surface(fewer);
  width_ = target.width();
  height_ = target.height();
  camera_ = camera.camera();
  const double far = camera.distance_m() + 4 * size_m_;
  projection_ = view_projection(camera_, width_, height_, std::max(1e-4, 0.02 * camera.distance_m()), far);
  scene_.resize(width_, height_, samples, GL_RGBA8);
  scene_.bind();
  glClear(GL_DEPTH_BUFFER_BIT);
  draw_background(frame, layers.floor);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  draw_body(colours);
  set_view(solid_program_);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  draw_points(frame, layers, colours);
  glEnable(GL_BLEND);
  if (layers.forces) {
    glDepthFunc(GL_GREATER);  // through the body, faintly
    glDepthMask(GL_FALSE);
    draw_forces(frame, forces, 0.30f);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    draw_forces(frame, forces, 1.0f);
  }
  if (layers.tool) draw_tool(frame);
  if (layers.device_ghost && !is_hand_) draw_ghost(frame);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  scene_.resolve_into(target);
  if (layers.rest_outline) draw_outline(target, samples);
  target.bind();
}

}  // namespace palpate
