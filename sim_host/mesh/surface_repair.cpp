#include "sim_host/mesh/surface_repair.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "config/body/self_intersection.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Halfedge = Mesh::Halfedge_index;
using Face = Mesh::Face_index;

constexpr double kDefaultHole = 0.2;  // of the extent
constexpr double kDefaultEdge = 1.0 / 40;
constexpr unsigned kRemeshRounds = 4;  // edge lengths have settled (2 leave a tenth of the edges off by half)

Vec3 vector_of(const Point& p) { return {p.x(), p.y(), p.z()}; }

std::string mm_text(double x_m) { return number_text(std::round(1e4 * x_m) / 10) + " mm"; }

class Repairer {
 public:
  Repairer(const RepairOptions& options, const std::string& label, const RepairStep& step)
      : options_(options), label_(label), step_(step) {}

  RepairedSurface run(const SurfaceMesh& surface) {
    extent_m_ = bounds_of(surface).largest_m();
    tell("joining triangles");
    join(surface);
    drop_parts();
    tell("looking for crossings");
    part_crossings();
    tell("closing holes");
    close_holes();
    keep_one_part();
    turn_outward();
    if (options_.remesh) {
      tell("making even triangles");
      remesh();
    }
    result_.mesh = surface_of_mesh();
    check_result();
    return std::move(result_);
  }

 private:
  void tell(const char* step) const {
    if (step_) step_(step);
  }
  void note(const std::string& what, Vec3 where_m) { result_.repair.push_back({what, where_m}); }
  [[noreturn]] void fail(const std::string& what, Vec3 where_m, const std::string& remedy) const {
    throw ConfigError(label_ + ": " + what + " at " + position_text(where_m) + "; " + remedy);
  }

  // Triangles that agree in direction along shared edges; where that cannot be, the surface is cut open and stitched
  // again where the sheets fit.
  void join(const SurfaceMesh& surface) {
    std::vector<Point> point;
    std::vector<std::vector<std::size_t>> face;
    for (const Vec3& p : surface.vertex_m) {
      if (!is_finite(p)) throw ConfigError(label_ + ": a vertex is not a number; export the surface again");
      point.emplace_back(p.x, p.y, p.z);
    }
    for (const Corners& t : surface.triangle)
      face.push_back({static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]), static_cast<std::size_t>(t[2])});
    const std::size_t faces = face.size();
    pmp::repair_polygon_soup(point, face);
    if (face.size() != faces)
      note(std::to_string(faces - face.size()) + " triangles without area, or there twice, left out", {});
    const bool agreed = turned_alike(surface);
    if (!pmp::orient_polygon_soup(point, face))
      note("edges or corners shared by more than two sheets cut open", first_shared_edge(surface));
    else if (!agreed)
      note("triangles turned to agree with their neighbours", {});
    pmp::polygon_soup_to_polygon_mesh(point, face, mesh_);
    const std::size_t stitched = pmp::stitch_borders(mesh_);
    if (stitched > 0) note(std::to_string(stitched) + " pairs of open edges stitched", {});
    const std::size_t before = mesh_.number_of_faces();
    pmp::remove_degenerate_faces(mesh_);
    mesh_.collect_garbage();
    if (mesh_.number_of_faces() != before)
      note(std::to_string(before - mesh_.number_of_faces()) + " triangles flat to a line taken out", {});
  }
  // No directed edge twice.
  static bool turned_alike(const SurfaceMesh& surface) {
    std::map<std::pair<std::int32_t, std::int32_t>, int> seen;
    for (const Corners& t : surface.triangle)
      for (std::size_t k = 0; k < 3; ++k)
        if (++seen[{t[k], t[(k + 1) % 3]}] > 1) return false;
    return true;
  }
  static Vec3 first_shared_edge(const SurfaceMesh& surface) {
    for (const auto& [edge, users] : edge_users(surface))
      if (users > 2) return surface.vertex_m[static_cast<std::size_t>(edge.first)];
    return {};
  }

  struct Part {
    std::size_t id = 0;
    double area_m2 = 0;
    std::size_t triangles = 0;
    std::vector<Vec3> corner_m;
    Bounds box;
  };
  // Largest first.
  std::vector<Part> parts() {
    part_of_ = mesh_.add_property_map<Face, std::size_t>("f:part", 0).first;
    std::vector<Part> part(pmp::connected_components(mesh_, part_of_));
    for (std::size_t i = 0; i < part.size(); ++i) part[i].id = i;
    for (const Face f : mesh_.faces()) {
      Part& p = part[part_of_[f]];
      p.area_m2 += CGAL::to_double(pmp::face_area(f, mesh_));
      ++p.triangles;
      for (const auto v : mesh_.vertices_around_face(mesh_.halfedge(f)))
        p.corner_m.push_back(vector_of(mesh_.point(v)));
    }
    for (Part& p : part) p.box = bounds_of(p.corner_m);
    std::ranges::stable_sort(part, [](const Part& a, const Part& b) { return a.area_m2 > b.area_m2; });
    return part;
  }
  void drop(const std::vector<Part>& dropped) {
    std::vector<std::size_t> id;
    for (const Part& p : dropped) {
      note("a part of " + std::to_string(p.triangles) + " triangles, " + mm_text(p.box.largest_m()) + " long, left out",
           p.box.middle_m());
      id.push_back(p.id);
    }
    if (!id.empty()) pmp::remove_connected_components(mesh_, id, part_of_);
    mesh_.collect_garbage();
  }
  // Crumbs of a scan; before holes are closed, or they would become bodies.
  void drop_parts() {
    std::vector<Part> part = parts(), dropped;
    if (part.empty()) throw ConfigError(label_ + ": no triangle with an area; is the unit right (--scale)?");
    for (std::size_t i = 1; i < part.size(); ++i)
      if (options_.keep_largest || part[i].box.largest_m() < kCrumb * part[0].box.largest_m())
        dropped.push_back(part[i]);
    drop(dropped);
  }
  void keep_one_part() {
    const std::vector<Part> part = parts();
    if (part.size() == 1) return;
    fail(std::to_string(part.size()) + " bodies, the second of " + std::to_string(part[1].triangles) +
             " triangles and " + mm_text(part[1].box.largest_m()),
         part[1].box.middle_m(),
         "--keep-largest leaves out all but the first; parts that belong together must be united in a mesh editor, an "
         "inner wall (a cavity) is not supported");
  }

  void part_crossings() {
    std::vector<std::pair<Face, Face>> pairs;
    pmp::self_intersections(mesh_, std::back_inserter(pairs));
    if (pairs.empty()) return;
    const Vec3 where_m = vector_of(mesh_.point(mesh_.target(mesh_.halfedge(pairs[0].first))));
    pmp::experimental::remove_self_intersections(mesh_);
    mesh_.collect_garbage();
    if (pmp::does_self_intersect(mesh_))
      fail("the surface goes through itself (" + std::to_string(pairs.size()) +
               " pairs of triangles), and parting it "
               "by itself did not succeed",
           where_m, "unite the parts, or remove the fold, in a mesh editor");
    note(std::to_string(pairs.size()) + " pairs of triangles that went through one another replaced", where_m);
  }

  void close_holes() {
    const double largest_m = options_.largest_hole_m > 0 ? options_.largest_hole_m : kDefaultHole * extent_m_;
    std::vector<Halfedge> cycle;
    pmp::extract_boundary_cycles(mesh_, std::back_inserter(cycle));
    for (const Halfedge border : cycle) {
      std::vector<Vec3> corner_m;
      double around_m = 0;
      std::size_t edges = 0;
      for (const Halfedge h : CGAL::halfedges_around_face(border, mesh_)) {
        corner_m.push_back(vector_of(mesh_.point(mesh_.target(h))));
        around_m += CGAL::to_double(pmp::edge_length(h, mesh_));
        ++edges;
      }
      const Bounds box = bounds_of(corner_m);
      const std::string hole = "hole of " + std::to_string(edges) + " edges, " + mm_text(around_m) + " around";
      if (box.largest_m() > largest_m)
        fail(hole + ", " + mm_text(box.largest_m()) + " across (largest that is closed: " + mm_text(largest_m) + ")",
             box.middle_m(),
             "close it in a mesh editor, or allow it by --hole-mm " + number_text(std::ceil(1e3 * box.largest_m())) +
                 " if a smooth lid is right");
      std::vector<Face> lid;
      std::vector<Mesh::Vertex_index> inner;
      pmp::triangulate_refine_and_fair_hole(mesh_, border, std::back_inserter(lid), std::back_inserter(inner));
      if (lid.empty()) fail(hole + ": no lid was found", box.middle_m(), "close it in a mesh editor");
      note(hole + ", closed by " + std::to_string(lid.size()) + " triangles", box.middle_m());
    }
  }

  void turn_outward() {
    if (pmp::is_outward_oriented(mesh_)) return;
    pmp::reverse_face_orientations(mesh_);
    note("the whole surface faced inwards: turned", {});
  }

  void remesh() {
    const Mesh before = mesh_;
    const double edge_m = options_.edge_m > 0 ? options_.edge_m : kDefaultEdge * extent_m_;
    auto sharp = mesh_.add_property_map<Mesh::Edge_index, bool>("e:sharp", false).first;
    pmp::detect_sharp_edges(mesh_, options_.sharp_deg, sharp);
    pmp::isotropic_remeshing(mesh_.faces(), edge_m, mesh_,
                             CGAL::parameters::number_of_iterations(kRemeshRounds)
                                 .number_of_relaxation_steps(3)
                                 .edge_is_constrained_map(sharp));
    mesh_.collect_garbage();
    result_.moved_m = std::max(distance_m(mesh_, before), distance_m(before, mesh_));
  }
  // Of the vertices of one from the other.
  static double distance_m(const Mesh& from, const Mesh& to) {
    std::vector<Point> point;
    for (const auto v : from.vertices()) point.push_back(from.point(v));
    return pmp::max_distance_to_triangle_mesh<CGAL::Sequential_tag>(point, to);
  }

  SurfaceMesh surface_of_mesh() const {
    SurfaceMesh surface;
    for (const auto v : mesh_.vertices()) surface.vertex_m.push_back(vector_of(mesh_.point(v)));
    for (const Face f : mesh_.faces()) {
      Corners corner{};
      std::size_t k = 0;
      for (const auto v : mesh_.vertices_around_face(mesh_.halfedge(f)))
        corner[k++] = static_cast<std::int32_t>(static_cast<std::uint32_t>(v));
      surface.triangle.push_back(corner);
    }
    return surface;
  }
  // What the baker would refuse is said here.
  void check_result() const {
    check_mesh(result_.mesh, label_);
    const SelfIntersections found = find_self_intersections(result_.mesh);
    if (found.pairs > 0)
      fail("the new triangles go through one another (" + std::to_string(found.pairs) + " pairs)", found.where_m,
           "walls there are thinner than an edge: give a smaller --edge-mm");
  }

  const RepairOptions& options_;
  const std::string& label_;
  const RepairStep& step_;
  double extent_m_ = 0;
  Mesh mesh_;
  Mesh::Property_map<Face, std::size_t> part_of_;
  RepairedSurface result_;
};

}  // namespace

EdgeUsers edge_users(const SurfaceMesh& mesh) {
  EdgeUsers users;
  for (const Corners& t : mesh.triangle)
    for (std::size_t k = 0; k < 3; ++k) ++users[std::minmax(t[k], t[(k + 1) % 3])];
  return users;
}

SurfaceState survey(const SurfaceMesh& mesh) {
  SurfaceState state;
  state.vertices = static_cast<std::int64_t>(mesh.vertex_m.size());
  state.triangles = static_cast<std::int64_t>(mesh.triangle.size());
  for (const auto& [edge, count] : edge_users(mesh)) {
    state.open_edges += count == 1 ? 1 : 0;
    state.shared_edges += count > 2 ? 1 : 0;
  }
  state.parts = component_count(mesh);
  state.crossings = find_self_intersections(mesh).pairs;
  state.volume_m3 = signed_volume_m3(mesh);
  state.area_m2 = surface_area_m2(mesh);
  state.bounds = bounds_of(mesh);
  return state;
}

RepairedSurface repair_surface(const SurfaceMesh& mesh, const RepairOptions& options, const std::string& label,
                               const RepairStep& step) {
  return Repairer(options, label, step).run(mesh);
}

}  // namespace palpate
