#include "config/body/support_surface.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "config/body/body.h"
#include "config/index.h"
#include "config/scene/config_error.h"
#include "rt_core/surface/triangle.h"

namespace palpate {

namespace {

// Of the body's size: how much nearer another triangle may be to a node on the border between the two.
constexpr double kSameDistance = 1e-7;

double distance_to(const SurfaceMesh& surface, const std::vector<std::size_t>& triangles, Vec3 p) {
  double least = kHuge;
  for (const std::size_t t : triangles) {
    const Corners& c = surface.triangle[t];
    least = std::min(least, squared_norm(closest_on_triangle(p, surface.vertex_m[at(c[0])], surface.vertex_m[at(c[1])],
                                                             surface.vertex_m[at(c[2])])
                                             .point -
                                         p));
  }
  return std::sqrt(least);
}

std::vector<std::int32_t> read_numbers(const std::string& path, const std::string& label) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw ConfigError(label + ": vertices_file: " + path + ": cannot be opened; check the path");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::int32_t> numbers;
  int line = 1;
  for (const char *c = text.data(), *end = c + text.size(); c != end;) {
    line += *c == '\n' ? 1 : 0;
    if (std::isspace(static_cast<unsigned char>(*c)) != 0) {
      ++c;
      continue;
    }
    std::int32_t number = 0;
    const auto [next, error] = std::from_chars(c, end, number);
    if (error != std::errc{} || number < 0 || (next != end && std::isspace(static_cast<unsigned char>(*next)) == 0))
      throw ConfigError(label + ": vertices_file: " + path + ":" + std::to_string(line) +
                        ": not a vertex's number; write whole numbers from 0, between blanks or line ends");
    numbers.push_back(number);
    c = next;
  }
  return numbers;
}

}  // namespace

SurfacePlace nearest_on(const SurfaceMesh& surface, Vec3 p) {
  SurfacePlace best;
  double least = kHuge;
  for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
    const Corners& c = surface.triangle[t];
    const Vec3 q =
        closest_on_triangle(p, surface.vertex_m[at(c[0])], surface.vertex_m[at(c[1])], surface.vertex_m[at(c[2])])
            .point;
    if (!(squared_norm(q - p) < least)) continue;
    least = squared_norm(q - p);
    best = {q, t};
  }
  return best;
}

void keep_surface(const TetSurface& skin, std::vector<char>& in) {
  std::vector<char> kept(in.size());
  for (const std::int32_t n : skin.node) kept[at(n)] = in[at(n)];
  in = std::move(kept);
}

void keep_joined(const TetSurface& skin, const SurfacePlace& place, std::vector<char>& in) {
  std::vector<std::vector<std::int32_t>> next(skin.mesh.vertex_m.size());
  for (const Corners& t : skin.mesh.triangle)
    for (std::size_t k = 0; k < 3; ++k) {
      next[at(t[k])].push_back(t[(k + 1) % 3]);
      next[at(t[k])].push_back(t[(k + 2) % 3]);
    }
  std::vector<char> kept(in.size());
  std::vector<std::int32_t> open;
  const auto keep = [&](std::int32_t vertex) {
    const std::size_t node = at(skin.node[at(vertex)]);
    if (in[node] == 0 || kept[node] != 0) return;
    kept[node] = 1;
    open.push_back(vertex);
  };
  for (const std::int32_t v : skin.mesh.triangle[place.triangle]) keep(v);
  while (!open.empty()) {
    const std::int32_t v = open.back();
    open.pop_back();
    for (const std::int32_t other : next[at(v)]) keep(other);
  }
  in = std::move(kept);
}

std::function<bool(Vec3)> on_listed_triangles(const SceneDesc& scene, const FixedDesc& entry,
                                              const std::string& label) {
  std::vector<std::string> unheard;
  SurfaceMesh surface = make_body(scene, unheard);
  const std::vector<std::int32_t> listed =
      entry.vertices_file.empty()
          ? entry.vertices
          : read_numbers((std::filesystem::path(scene.source.directory) / entry.vertices_file).string(), label);
  std::vector<char> is_listed(surface.vertex_m.size());
  for (const std::int32_t v : listed) {
    if (at(v) >= is_listed.size())
      throw ConfigError(label + ": vertex " + std::to_string(v) + " is not of the body's surface, which has " +
                        std::to_string(is_listed.size()) + ", numbered from 0");
    is_listed[at(v)] = 1;
  }
  std::vector<std::size_t> inside, outside;
  for (std::size_t t = 0; t < surface.triangle.size(); ++t)
    (std::ranges::all_of(surface.triangle[t], [&](std::int32_t v) { return is_listed[at(v)] != 0; }) ? inside : outside)
        .push_back(t);
  if (inside.empty())
    throw ConfigError(label + ": no triangle of the surface has all its corners among the " +
                      std::to_string(listed.size()) + " listed vertices; list whole triangles");
  const double tolerance_m = kSameDistance * bounds_of(surface).largest_m();
  return [surface = std::move(surface), inside = std::move(inside), outside = std::move(outside), tolerance_m](Vec3 p) {
    return distance_to(surface, inside, p) <= distance_to(surface, outside, p) + tolerance_m;
  };
}

}  // namespace palpate
