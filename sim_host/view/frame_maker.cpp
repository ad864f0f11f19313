#include "sim_host/view/frame_maker.h"

#include <algorithm>
#include <chrono>
#include <tuple>

#include "rt_core/contact/contact.h"

namespace palpate {

DrawnBody drawn_body(const std::vector<std::array<std::int32_t, 3>>& triangle,
                     const std::vector<std::array<Vec3, 3>>& corner_normal) {
  const auto normal_of = [&](const DrawnBody::Source& s) {
    return corner_normal[static_cast<std::size_t>(s.triangle)][static_cast<std::size_t>(s.corner)];
  };
  std::vector<DrawnBody::Source> corner;  // all of them, by vertex
  for (std::size_t t = 0; t < triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      corner.push_back({triangle[t][k], static_cast<std::int32_t>(t), static_cast<std::int32_t>(k)});
  std::ranges::sort(corner, {}, [](const DrawnBody::Source& s) { return std::tuple(s.vertex, s.triangle, s.corner); });
  DrawnBody body;
  body.triangle.resize(triangle.size());
  // Vertices already made of each surface vertex: a smooth one has one, a point on a crease one for each side.
  std::size_t first = 0;
  for (const DrawnBody::Source& s : corner) {
    if (first < body.source.size() && body.source[first].vertex != s.vertex) first = body.source.size();
    std::size_t made = first;
    while (made < body.source.size() && !(squared_norm(normal_of(body.source[made]) - normal_of(s)) < 1e-6)) ++made;
    if (made == body.source.size()) body.source.push_back(s);
    body.triangle[static_cast<std::size_t>(s.triangle)][static_cast<std::size_t>(s.corner)] =
        static_cast<std::uint32_t>(made);
  }
  return body;
}

std::vector<DrawnVertex> drawn_vertices(const DrawnBody& body, const DeformedSurface& surface) {
  std::vector<DrawnVertex> vertices;
  vertices.reserve(body.source.size());
  for (const DrawnBody::Source& s : body.source) {
    const auto v = static_cast<std::size_t>(s.vertex);
    const Vec3 p = surface.position_m[v];
    const Vec3 n = surface.corner_normal[static_cast<std::size_t>(s.triangle)][static_cast<std::size_t>(s.corner)];
    vertices.push_back({{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
                        {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)},
                        static_cast<float>(norm(surface.displacement_m[v])),
                        static_cast<float>(surface_value(surface, v, SurfaceColour::kPressure))});
  }
  return vertices;
}

FrameMaker::FrameMaker(const Model& model, const RunTrack& track, StatePtr initial, std::size_t most_triangles,
                       bool in_shader)
    : model_(model),
      refined_(model, most_triangles),
      in_shader_(in_shader && method_of(model) == Method::kElastic),
      states_(model, track, copy_of(*initial)),
      drawn_(drawn_body(refined_.triangle(), refined_.corner_normal())),
      at_rest_(drawn_vertices(drawn_, refined_.shape(*initial))),
      track_(track) {
  thread_ = std::thread([this] { run(); });
}

FrameMaker::~FrameMaker() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FrameMaker::want(std::size_t index) {
  {
    const std::lock_guard lock(mutex_);
    if (wanted_ == index && asked_) return;
    wanted_ = index;
    asked_ = true;
  }
  changed_.notify_all();
}

std::shared_ptr<const ViewFrame> FrameMaker::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

std::shared_ptr<const ViewFrame> FrameMaker::wait_for(std::size_t index) {
  want(index);
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return newest_ && newest_->index == index; });
  return newest_;
}

std::shared_ptr<const ViewFrame> FrameMaker::make(std::size_t index) {
  // So long a way is taken in pieces, so that a new wish or the end is noticed; each piece is a frame on the way.
  constexpr std::size_t kTicksAtOnce = 500;
  const auto start = std::chrono::steady_clock::now();
  const State& state = states_.go_to(index, kTicksAtOnce);
  auto frame = std::make_shared<ViewFrame>();
  frame->index = states_.reached();
  frame->state = copy_of(state);
  DeformedSurface surface;
  if (in_shader_) {
    frame->elastic = elastic_shape(model_, state);
  } else {
    surface = refined_.shape(state);
    frame->vertex = drawn_vertices(drawn_, surface);
  }
  const AnchorField anchors = anchors_of(model_, state);
  for (const auto& [name, colour] : surface_colours())
    frame->largest[static_cast<std::size_t>(colour)] = largest_value(surface, anchors, colour);
  frame->made_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return frame;
}

void FrameMaker::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || (asked_ && (!newest_ || newest_->index != wanted_)); });
    if (ending_) return;
    const std::size_t wanted = wanted_;
    if (track_.size() == 0) {
      asked_ = false;
      continue;
    }
    lock.unlock();
    std::shared_ptr<const ViewFrame> frame = make(wanted);
    lock.lock();
    // Beyond the track's end there is nothing to wait for.
    if (frame->index != wanted && frame->index + 1 == track_.size() && wanted_ == wanted) asked_ = false;
    newest_ = std::move(frame);
    changed_.notify_all();
  }
}

}  // namespace palpate
