#include "sim_host/view/mesh_raster.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {

Projection::Projection(const Camera& camera, int width, int height)
    : eye_(camera.eye_m),
      scale_(0.5 * height / std::tan(0.5 * camera.vertical_fov_rad)),
      centre_x_(0.5 * width),
      centre_y_(0.5 * height) {
  forward_ = unit_or(camera.target_m - camera.eye_m, {0, 1, 0});
  right_ = unit_or(cross(forward_, camera.up), {1, 0, 0});
  up_ = cross(right_, forward_);
}

Vec3 Projection::operator()(Vec3 point_w) const {
  const Vec3 d = point_w - eye_;
  const double depth = dot(d, forward_);
  if (!(depth > 1e-6)) return {0, 0, -1};
  return {centre_x_ + scale_ * dot(d, right_) / depth, centre_y_ - scale_ * dot(d, up_) / depth, depth};
}

Vec3 Projection::ray(double x, double y) const {
  return forward_ + ((x - centre_x_) / scale_) * right_ - ((y - centre_y_) / scale_) * up_;
}

PlacedMesh::PlacedMesh(RenderMesh drawn, const Projection& projection, std::int32_t of_material)
    : mesh(std::move(drawn)), material(of_material) {
  for (const Vec3 p : mesh.position_m) screen.push_back(projection(p));
}

Layer::Layer(int width, int height, int rows)
    : width_(width),
      height_(height),
      rows_(rows),
      surfels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows)) {}

void Layer::begin(int first) {
  first_ = first;
  std::ranges::fill(surfels_, Surfel{});
}

void Layer::draw(const PlacedMesh& placed) {
  for (const auto& corner : placed.mesh.triangle) draw_triangle(placed, corner);
}

// Edge functions at pixel centres; attributes are interpolated linearly in 1/z, as perspective demands.
void Layer::draw_triangle(const PlacedMesh& placed, const std::array<std::int32_t, 3>& corner) {
  const RenderMesh& mesh = placed.mesh;
  Vec3 p[3];
  for (std::size_t k = 0; k < 3; ++k) p[k] = placed.screen[static_cast<std::size_t>(corner[k])];
  if (p[0].z <= 0 || p[1].z <= 0 || p[2].z <= 0) return;
  const auto low = [](double a, double b, double c) { return std::floor(std::min({a, b, c}) - 0.5); };
  const auto high = [](double a, double b, double c) { return std::ceil(std::max({a, b, c}) + 0.5); };
  const int y0 = static_cast<int>(std::max<double>(first_, low(p[0].y, p[1].y, p[2].y)));
  const int y1 = static_cast<int>(std::min<double>(std::min(first_ + rows_, height_), high(p[0].y, p[1].y, p[2].y)));
  if (y0 >= y1) return;
  const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
  if (!(std::abs(area) > 1e-12)) return;
  const int x0 = static_cast<int>(std::max(0.0, low(p[0].x, p[1].x, p[2].x)));
  const int x1 = static_cast<int>(std::min<double>(width_, high(p[0].x, p[1].x, p[2].x)));
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      double w[3];
      for (int k = 0; k < 3; ++k) {
        const Vec3 a = p[(k + 1) % 3], b = p[(k + 2) % 3];
        w[k] = ((b.x - a.x) * (y + 0.5 - a.y) - (b.y - a.y) * (x + 0.5 - a.x)) / area;
      }
      if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
      const double inverse = w[0] / p[0].z + w[1] / p[1].z + w[2] / p[2].z;
      Surfel& surfel = surfels_[static_cast<std::size_t>(y - first_) * static_cast<std::size_t>(width_) +
                                static_cast<std::size_t>(x)];
      const auto depth = static_cast<float>(1.0 / inverse);
      if (!(depth < surfel.depth_m)) continue;
      Vec3 normal;
      double value = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(corner[k]);
        const double share = w[k] / p[k].z / inverse;
        normal += share * mesh.normal[v];
        if (!mesh.value.empty()) value += share * mesh.value[v];
      }
      surfel = {depth,
                static_cast<float>(value),
                {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)},
                placed.material};
    }
  }
}

namespace {

constexpr double kTwoPi = 6.28318530717958648;

// A sphere's worth of directions on a grid of rings; `place` maps a direction to the surface point it supports.
template <typename Place>
RenderMesh support_mesh(const Pose& pose, int rings, int sectors, Place place) {
  RenderMesh mesh;
  for (int i = 0; i <= rings; ++i) {
    const double polar = 0.5 * kTwoPi * i / rings;
    for (int j = 0; j < sectors; ++j) {
      const double turn = kTwoPi * j / sectors;
      const Vec3 n{std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), -std::cos(polar)};
      mesh.position_m.push_back(transform(pose, place(n)));
      mesh.normal.push_back(rotate(pose.orientation, n));
    }
  }
  const auto id = [sectors](int i, int j) { return static_cast<std::int32_t>(i * sectors + j % sectors); };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      mesh.triangle.push_back({id(i, j), id(i, j + 1), id(i + 1, j + 1)});
      mesh.triangle.push_back({id(i, j), id(i + 1, j + 1), id(i + 1, j)});
    }
  }
  return mesh;
}

}  // namespace

RenderMesh sphere_mesh(const Pose& pose, double radius_m) {
  return support_mesh(pose, 40, 64, [radius_m](Vec3 n) { return radius_m * n; });
}

// The profile of the rounded body is the core polygon's offset curve: an arc of radius margin_m about every corner
// between the normals of its two edges, swept about the axis.
RenderMesh revolved_mesh(const Pose& pose, std::span<const Point2> core, double margin_m, bool ring) {
  struct ProfileVertex {
    Point2 point, normal;
  };
  std::vector<ProfileVertex> profile;
  double angle = -0.25 * kTwoPi;  // of the outward normal in the (radius, z) half plane; starts straight down
  for (std::size_t i = 0; i < core.size(); ++i) {
    double next = (ring ? 0.75 : 0.25) * kTwoPi;
    if (i + 1 < core.size()) {
      next = std::atan2(-(core[i + 1].x - core[i].x), core[i + 1].y - core[i].y);
    }
    const int kArc = ring ? 40 : 10;
    for (int k = 0; k <= kArc; ++k) {
      const double a = angle + (next - angle) * k / kArc;
      const Point2 n{std::cos(a), std::sin(a)};
      profile.push_back({{core[i].x + margin_m * n.x, core[i].y + margin_m * n.y}, n});
    }
    angle = next;
  }
  constexpr int kSectors = 72;
  RenderMesh mesh;
  for (const ProfileVertex& v : profile) {
    for (int j = 0; j < kSectors; ++j) {
      const double turn = kTwoPi * j / kSectors, c = std::cos(turn), s = std::sin(turn);
      mesh.position_m.push_back(transform(pose, {v.point.x * c, v.point.x * s, v.point.y}));
      mesh.normal.push_back(rotate(pose.orientation, {v.normal.x * c, v.normal.x * s, v.normal.y}));
    }
  }
  const auto id = [](std::size_t i, int j) { return static_cast<std::int32_t>(i) * kSectors + j % kSectors; };
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (int j = 0; j < kSectors; ++j) {
      mesh.triangle.push_back({id(i, j), id(i, j + 1), id(i + 1, j + 1)});
      mesh.triangle.push_back({id(i, j), id(i + 1, j + 1), id(i + 1, j)});
    }
  }
  return mesh;
}

RenderMesh hull_mesh(const Pose& pose, std::span<const Vec3> vertices_m, double margin_m) {
  return support_mesh(pose, 180, 360, [vertices_m, margin_m](Vec3 n) {
    Vec3 best;
    double reach = -1e30;
    for (const Vec3 v : vertices_m) {
      if (dot(v, n) > reach) reach = dot(v, n), best = v;
    }
    return best + margin_m * n;
  });
}

RenderMesh arrow_mesh(Vec3 tail_w, Vec3 tip_w, double shaft_radius_m) {
  const double length = norm(tip_w - tail_w);
  const double head = std::min(0.5 * length, 5 * shaft_radius_m);
  const Pose pose{tail_w, rotation_between({0, 0, 1}, unit_or(tip_w - tail_w, {0, 0, 1}))};
  const Point2 profile[] = {
      {0, 0}, {shaft_radius_m, 0}, {shaft_radius_m, length - head}, {2.2 * shaft_radius_m, length - head}, {0, length}};
  return revolved_mesh(pose, profile, 0);
}

}  // namespace palpate
