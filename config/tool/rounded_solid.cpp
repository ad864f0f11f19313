#include "config/tool/rounded_solid.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "config/bake/tool_points.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"
#include "config/tool/piece_card.h"
#include "rt_core/contact/tips/line_law.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

constexpr double kOnePlane_rad = 1e-3;  // between faces: less is no edge
// A flat tip of this radius, of the root of a face's area, and the frame of its edges are 2 to 7 % softer than a square
// or a plate of 2 : 1 that is flat all over (boundary elements, margins of an eighth of the face, 2026-11-26).
constexpr double kPlate = 0.45;
// Of the way from the face's middle to its edge: so far the tip follows a crest.
constexpr double kSlides = 0.5;
// Of the margin: across a narrower face its two edges' contacts meet.
constexpr double kNarrow = 1.5;

struct Edge {
  std::size_t from, to;
  Vec3 normal[2];  // of the faces that meet there
};
struct Face {
  Vec3 normal;
  std::vector<Corners> triangle;
};

// The rotation vector of a quaternion.
Vec3 rotation_vector(Quat q) {
  const Vec3 v{q.x, q.y, q.z};
  const double sine = norm(v);
  return sine > 0 ? (2 * math::atan2(sine, q.w) / sine) * v : Vec3{};
}
// Carries z to a unit vector.
Quat upright(Vec3 z) { return z.z > -0.999 ? rotation_between({0, 0, 1}, z) : Quat{0, 1, 0, 0}; }
// Carries x to `x` and z to `z`, which are at right angles.
Quat frame(Vec3 x, Vec3 z) {
  const Quat up = upright(z);
  const Vec3 turned = rotate(conjugate(up), x);
  const double half = 0.5 * math::atan2(turned.y, turned.x);
  return up * Quat{math::cos(half), 0, 0, math::sin(half)};
}

class Solid {
 public:
  Solid(const PieceDesc& piece, const std::string& where) : piece_(piece) {
    const PieceCore core = piece_core(piece);
    margin_m_ = core.margin_m;
    corner_ = card_of(piece.shape).corners(core);
    pose_ = {piece.position_m, rotation_of(piece.rotation_rad)};
    if (!(margin_m_ > 0))
      throw ConfigError(where +
                        ".margin_mm: 0, but what touches an elastic body is round at its edges; allowed above 0");
    find_faces();
    if (face_.size() < 4)
      throw ConfigError(where +
                        ".shape: the core lies in a plane or in a line, and touches an elastic body with no "
                        "faces; give it some thickness, or take a capsule, a sphere or a cylinder");
    find_edges();
  }

  std::vector<PieceDesc> parts() const {
    std::vector<PieceDesc> out;
    for (const Edge& edge : edge_) out.push_back(capsule(edge));
    for (const Face& face : face_) add_plate(face, out);
    return out;
  }

 private:
  Vec3 at(std::int32_t i) const { return corner_[static_cast<std::size_t>(i)]; }

  void find_faces() {
    for (const Corners& c : convex_hull(corner_)) {
      const Vec3 twice = cross(at(c[1]) - at(c[0]), at(c[2]) - at(c[0]));
      const Vec3 normal = unit_or(twice, {});
      if (normal == Vec3{}) continue;
      const auto known = std::ranges::find_if(face_, [&](const Face& f) {
        return dot(f.normal, normal) > 0 && norm(cross(f.normal, normal)) < kOnePlane_rad;
      });
      if (known != face_.end())
        known->triangle.push_back(c);
      else
        face_.push_back({normal, {c}});
    }
  }
  void find_edges() {
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> seen;  // the face on one side
    for (std::size_t f = 0; f < face_.size(); ++f)
      for (const Corners& c : face_[f].triangle)
        for (std::size_t k = 0; k < 3; ++k) {
          const auto ends = std::minmax(c[k], c[(k + 1) % 3]);
          const auto [other, is_new] = seen.try_emplace({ends.first, ends.second}, f);
          if (!is_new && other->second != f)
            edge_.push_back({static_cast<std::size_t>(ends.first),
                             static_cast<std::size_t>(ends.second),
                             {face_[other->second].normal, face_[f].normal}});
        }
  }

  // What of an edge's ball at a corner is its own: of n pressed into the body there the shares s (1 - (n . edge)^2) of
  // all its edges make one ball. At a box's corner they do so exactly, along every n, since the squares of n's
  // components add up to one; elsewhere about where the edge itself lies on the body.
  double share(const Edge& own, std::size_t corner) const {
    const Vec3 pressed = unit_or(own.normal[0] + own.normal[1], {});
    double sum = 0;
    for (const Edge& edge : edge_)
      if (edge.from == corner || edge.to == corner)
        sum += LineLaw::end_share(1, dot(pressed, unit_or(corner_[edge.to] - corner_[edge.from], {})));
    return std::min(1 / sum, 1.0);
  }

  PieceDesc part(PieceShape shape, Vec3 middle, Quat turn) const {
    PieceDesc out = piece_;
    out.shape = shape;
    out.is_of_solid = true;
    out.size_m = {kAuto, kAuto, kAuto};
    out.vertices_m.clear();
    out.position_m = transform(pose_, middle);
    out.rotation_rad = rotation_vector(pose_.orientation * turn);
    return out;
  }
  PieceDesc capsule(const Edge& edge) const {
    const Vec3 from = corner_[edge.from], to = corner_[edge.to], along = unit_or(to - from, {0, 0, 1});
    PieceDesc out = part(PieceShape::kCapsule, 0.5 * (from + to), upright(along));
    out.radius_m = margin_m_;
    out.margin_m = kAuto;
    out.length_m = norm(to - from) + 2 * margin_m_;
    out.end_left[0] = 1 - share(edge, edge.from);
    out.end_left[1] = 1 - share(edge, edge.to);
    return out;
  }

  // A flat tip as stiff as the face, which its edges' frame carries with it.
  void add_plate(const Face& face, std::vector<PieceDesc>& out) const {
    double area = 0;
    Vec3 middle;
    for (const Corners& c : face.triangle) {
      const double part = 0.5 * norm(cross(at(c[1]) - at(c[0]), at(c[2]) - at(c[0])));
      area += part;
      middle += part / 3 * (at(c[0]) + at(c[1]) + at(c[2]));
    }
    middle = (1 / area) * middle;
    Vec3 along;
    double nearest = kHuge;
    for (const Edge& edge : edge_)
      if (is_of(edge, face)) {
        const Vec3 way = corner_[edge.to] - corner_[edge.from];
        if (norm(way) > norm(along)) along = way;
        nearest = std::min(nearest, distance(edge, face, middle));
      }
    if (!(nearest > kNarrow * margin_m_)) return;
    along = unit_or(along, {});
    const Vec3 across = cross(face.normal, along);
    const double u = kSlides * reach(face, middle, along), v = kSlides * reach(face, middle, across);
    PieceDesc plate = part(PieceShape::kBox, middle, frame(along, face.normal));
    plate.margin_m = margin_m_;
    plate.radius_m = kPlate * std::sqrt(area);
    plate.size_m = {2 * (u + margin_m_), 2 * (v + margin_m_), 2 * margin_m_};
    out.push_back(plate);
  }
  static bool is_of(const Edge& edge, const Face& face) {
    return edge.normal[0] == face.normal || edge.normal[1] == face.normal;
  }
  // Of a place in the face's plane from an edge's line.
  double distance(const Edge& edge, const Face& face, Vec3 place) const {
    const Vec3 across = cross(unit_or(corner_[edge.to] - corner_[edge.from], {}), face.normal);
    return std::abs(dot(corner_[edge.from] - place, across));
  }
  // How far the face goes on from a place, towards the nearer end.
  double reach(const Face& face, Vec3 place, Vec3 way) const {
    double most = kHuge;
    for (const Edge& edge : edge_) {
      if (!is_of(edge, face)) continue;
      const Vec3 across = cross(unit_or(corner_[edge.to] - corner_[edge.from], {}), face.normal);
      const double slope = std::abs(dot(way, across));
      if (slope > 0.1) most = std::min(most, distance(edge, face, place) / slope);
    }
    return most;
  }

  const PieceDesc& piece_;
  Pose pose_;
  double margin_m_ = 0;
  std::vector<Vec3> corner_;
  std::vector<Face> face_;
  std::vector<Edge> edge_;
};

bool is_solid(const PieceDesc& piece) {
  return (piece.shape == PieceShape::kBox || piece.shape == PieceShape::kHull) && piece.points == 1 &&
         !piece.is_of_solid && piece.touches == TouchingEnd::kAll;
}

}  // namespace

void take_apart_solids(SceneDesc& scene) {
  const std::size_t written = scene.piece.size();
  for (std::size_t i = 0; i < written; ++i) {
    if (!is_solid(scene.piece[i])) continue;
    const std::string where = scene.source.where("tool.piece[" + std::to_string(i) + "]");
    const std::vector<PieceDesc> parts = Solid(scene.piece[i], where).parts();
    const std::size_t room = kMaxPieces - scene.piece.size();
    if (parts.size() > room)
      throw ConfigError(where + ".shape: touches an elastic body with " + std::to_string(parts.size()) +
                        " edges and faces, and " + std::to_string(room) + " of the " + std::to_string(kMaxPieces) +
                        " pieces of a tool are left; give it fewer corners, points = 0 where it does not touch, or a "
                        "sphere, capsule, cylinder or cone for what is round");
    scene.piece[i].points = 0;
    scene.piece.insert(scene.piece.end(), parts.begin(), parts.end());
  }
}

}  // namespace palpate
