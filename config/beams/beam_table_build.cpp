#include "config/beams/beam_table_build.h"

#include <Eigen/LU>
#include <algorithm>

#include "config/body/mesh.h"
#include "config/scene/config_error.h"
#include "config/scene/scene.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

// Grid cells across the thinnest wall: the trilinear distance then errs by 1 % of the wall at its middle.
constexpr double kCellsPerWall = 8;
// How far a beam may leave the facetted surface, of the wall: facets lie inside the smooth surface they stand for.
constexpr double kTolerance = 0.03;
constexpr double kAutoWidth = 0.25;  // of the wall

// The surface of an image under construction, as the model's queries need it.
Model surface_of(const ImageContents& image) {
  Model model;
  model.vertex_m = image.vertex_m;
  model.vertex_normal = image.vertex_normal;
  model.triangle = image.triangle;
  model.bvh = image.bvh;
  model.sizes.n_vertex = static_cast<std::int64_t>(image.vertex_m.size());
  model.sizes.n_triangle = static_cast<std::int64_t>(image.triangle.size());
  model.sizes.n_bvh = static_cast<std::int64_t>(image.bvh.size());
  return model;
}

double mean_edge_m(const Model& surface) {
  double sum = 0;
  for (const Triangle& t : surface.triangle)
    for (int k = 0; k < 3; ++k)
      sum += norm(surface.vertex_m[static_cast<std::size_t>(t.vertex[k])] -
                  surface.vertex_m[static_cast<std::size_t>(t.vertex[(k + 1) % 3])]);
  return sum / (3.0 * static_cast<double>(surface.triangle.size()));
}

double largest_extent_m(const Model& surface) {
  Vec3 low = surface.vertex_m[0], high = low;
  for (const Vec3& p : surface.vertex_m) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 size = high - low;
  return std::max({size.x, size.y, size.z});
}

// Thinnest wall. A coarse grid over the body finds it roughly, a fine one over the wall properly.
double thinnest_wall_m(const Model& surface, double cell_m, double longest_m) {
  const DistanceGrid grid(surface, cell_m);
  const std::vector<double> wall = wall_thickness_m(surface, grid, longest_m);
  return *std::min_element(wall.begin(), wall.end());
}

Vec3 vec(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

BeamStiffness stiffness_entry(const Eigen::Matrix3d& k) {
  return {{k(0, 0), k(0, 1), k(0, 2), k(1, 1), k(1, 2), k(2, 2)}};
}
BeamResponse response_entry(const BeamRows& rows) {
  BeamResponse r{};
  for (int i = 0; i < 3; ++i) r.release_m_per_N[i] = vec(rows.release.row(i).transpose());
  Vec3* stress[6] = {&r.inner_Pa_per_N, &r.outer_Pa_per_N,    &r.side_Pa_per_N,
                     &r.axial_Pa_per_N, &r.shear_in_Pa_per_N, &r.shear_out_Pa_per_N};
  for (int i = 0; i < 6; ++i) *stress[i] = vec(rows.stress.row(i).transpose());
  return r;
}

void count(const BeamChoice& choice, std::size_t anchor, BeamTableReport& report) {
  const BeamPath path = choice.count > 0 ? choice.curve[0].path : BeamPath::kNone;
  report.count[static_cast<std::size_t>(path)] += 1;
  report.two_ways += choice.count == 2 ? 1 : 0;
  report.dropped_by_anchor[anchor] += choice.count == 0 ? 1 : 0;
}

}  // namespace

BeamTableReport build_beam_table(const BeamTableRule& rule, double volume_m3, ImageContents& image) {
  BeamTableReport report;
  const Model surface = surface_of(image);
  const std::size_t anchors = image.anchor.size(), vertices = image.vertex_m.size();
  report.dropped_by_anchor.assign(anchors, 0);
  const double size = largest_extent_m(surface);
  const double rough = thinnest_wall_m(surface, size / 64, size);
  const DistanceGrid grid(surface, rough / kCellsPerWall);
  const std::vector<double> wall = wall_thickness_m(surface, grid, size);
  report.wall_m = *std::min_element(wall.begin(), wall.end());
  report.width_m = is_auto(rule.width_m) ? kAutoWidth * report.wall_m : rule.width_m;
  if (!(report.width_m < report.wall_m))
    throw ConfigError("the beams' width of " + number_text(1e3 * report.width_m) +
                      " mm is not below the thinnest wall, " + number_text(1e3 * report.wall_m) +
                      " mm; lower it, or thicken the wall");

  const BeamSelector selector(surface, grid, {report.width_m, rule.allowance_m, rule.paper}, kTolerance * report.wall_m,
                              mean_edge_m(surface));
  std::vector<BeamChoice> choice(vertices * anchors);
  double length = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    bool any = false;
    for (std::size_t a = 0; a < anchors; ++a) {
      BeamChoice& c = choice[v * anchors + a];
      c = selector.choose(static_cast<std::int32_t>(v), image.anchor[a].position_m, image.anchor[a].normal);
      count(c, a, report);
      if (c.count > 0) length += c.curve[0].length_m / static_cast<double>(vertices);
      any = any || c.count > 0;
    }
    report.lonely_vertices += any ? 0 : 1;
  }

  BeamBuild build;
  build.material = {image.params.youngs_modulus_Pa, image.params.poisson_ratio};
  build.width_m = report.width_m;
  build.thickness_m =
      is_auto(rule.thickness_m) ? volume_m3 / (report.width_m * std::max(length, 1e-9)) : rule.thickness_m;
  build.paper = rule.paper;
  const double nu = build.material.poisson_ratio;
  build.release_length_m = 0.5 * kPi * build.equivalent_radius_m() * (1 - nu * nu);
  report.thickness_m = build.thickness_m;
  report.release_length_m = build.release_length_m;
  for (Anchor& a : image.anchor) {
    a.section_area_m2 = build.width_m * build.thickness_m;
    a.section_inertia_m4 = a.section_area_m2 * build.width_m * build.width_m / 12;
    a.section_radius_m = build.equivalent_radius_m();
    a.release_length_m = build.release_length_m;
  }
  for (std::size_t v = 0; v < vertices; ++v)
    for (std::size_t a = 0; a < anchors; ++a) {
      const BeamRows rows = beam_rows(choice[v * anchors + a], build, image.anchor[a].normal);
      if (rule.paper) {
        image.beam_ratio.push_back(rows.ratio);
      } else {
        image.beam_stiffness.push_back(stiffness_entry(rows.stiffness));
      }
      image.beam_response.push_back(response_entry(rows));
    }
  return report;
}

}  // namespace palpate
