// Beams of objects with holes: meshes, selection rules, mechanics, tables; and what they do when pressed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <set>

#include "config/bake/compile.h"
#include "config/bake/opened_image.h"
#include "config/beams/beam_rows.h"
#include "config/scene/config_error.h"
#include "rt_core/image.h"
#include "rt_core/skeleton/beam_table.h"
#include "rt_core/surface/closest_point.h"
#include "sim_host/view/anchors.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

void expect_close(Vec3 a, Vec3 b, double tolerance) { EXPECT_NEAR(norm(a - b), 0, tolerance); }

// --- Meshes
// -----------------------------------------------------------------------------------------------------------

std::int64_t euler_characteristic(const SurfaceMesh& mesh) {
  const auto vertices = static_cast<std::int64_t>(mesh.vertex_m.size());
  const auto triangles = static_cast<std::int64_t>(mesh.triangle.size());
  return vertices - 3 * triangles / 2 + triangles;
}

TEST(HollowBodies, AreClosedAndHaveTheirHoles) {
  const SurfaceMesh shell = make_half_shell({50e-3, 40e-3, 40e-3}, 10e-3, 5428);
  const SurfaceMesh ring = make_ring(50e-3, 20e-3, BodyAxis::kZ, 2304);
  const SurfaceMesh tube = make_hollow_cylinder(35e-3, 10e-3, 70e-3, BodyAxis::kY, 3024);
  for (const SurfaceMesh* mesh : {&shell, &ring, &tube}) {
    EXPECT_NO_THROW(check_mesh(*mesh, "mesh"));  // closed, manifold, outward, one piece
    EXPECT_NEAR(bounds_of(*mesh).lower_m.y, 0, 1e-12);
  }
  EXPECT_EQ(euler_characteristic(shell), 2);
  EXPECT_EQ(euler_characteristic(ring), 0);  // genus 1
  EXPECT_EQ(euler_characteristic(tube), 0);
  EXPECT_NEAR(static_cast<double>(shell.triangle.size()), 5428, 0.5 * 12 * 20);  // a rim row of 20 more or less
  EXPECT_EQ(ring.triangle.size(), 2304u);
  EXPECT_EQ(tube.triangle.size(), 3024u);
  // Volumes: facets lie inside convex parts, hence a little less; 2 % at these sizes of cells.
  EXPECT_NEAR(signed_volume_m3(shell) / (2.0 / 3 * kPi * (50e-3 * 40e-3 * 40e-3 - 40e-3 * 30e-3 * 30e-3)), 1, 0.02);
  EXPECT_NEAR(signed_volume_m3(ring) / (2 * kPi * 40e-3 * kPi * 1e-4), 1, 0.03);
  EXPECT_NEAR(signed_volume_m3(tube) / (kPi * (35e-3 * 35e-3 - 25e-3 * 25e-3) * 70e-3), 1, 0.02);
}

TEST(HollowBodies, AreMirrorImagesOfThemselves) {
  const SurfaceMesh ring = make_ring(50e-3, 20e-3, BodyAxis::kZ, 2304);
  const auto key = [](Vec3 p) {
    return std::array<long, 3>{std::lround(1e9 * p.x), std::lround(1e9 * p.y), std::lround(1e9 * p.z)};
  };
  std::set<std::array<long, 3>> centres;
  const auto centre = [&](const Corners& c) {
    Vec3 sum;
    for (const std::int32_t v : c) sum += ring.vertex_m[static_cast<std::size_t>(v)];
    return sum;
  };
  for (const Corners& c : ring.triangle) centres.insert(key(centre(c)));
  for (const Corners& c : ring.triangle) {
    const Vec3 p = centre(c);
    EXPECT_TRUE(centres.count(key({-p.x, p.y, p.z})));
    EXPECT_TRUE(centres.count(key({p.x, 6 * 50e-3 - p.y, p.z})));  // three corners, each about y = 50 mm
    EXPECT_TRUE(centres.count(key({p.x, p.y, -p.z})));
  }
}

// --- Geometry
// ---------------------------------------------------------------------------------------------------------

TEST(BeamCurves, CircleOfTheWorkedExample) {
  // Ellipse 40 x 25 mm, P at the end of one axis, A of the other; the smaller end curvature 15.625 / m, epsilon 0.5 mm.
  const Vec3 p{0, 25e-3, 0}, a{40e-3, 0, 0};
  const Vec3 along = unit_or(a - p, {});
  const Vec3 inside{-std::abs(along.y), -along.x, 0};
  const BeamCurve arc = arc_through(p, a, inside, 1 / 15.625 + 0.5e-3, false);
  EXPECT_NEAR(arc.angle * 180 / kPi, 42.896188, 6e-7);
  expect_close(arc.centre_m, {-11.8176e-3, -38.4082e-3, 0}, 1e-7);
  expect_close(curve_point(arc, 0, 0), p, 1e-15);
  expect_close(curve_point(arc, 1, 0), a, 1e-15);
  EXPECT_GT(dot(curve_point(arc, 0.5, 0) - 0.5 * (p + a), inside), -1);
  EXPECT_LT(dot(curve_point(arc, 0.5, 0) - 0.5 * (p + a), inside), 0);  // it bulges away from the centre
}

TEST(BeamCurves, DegenerateChords) {
  const Vec3 p{0, 0, 0}, a{10e-3, 0, 0}, inside{0, -1, 0};
  const BeamCurve half = arc_through(p, a, inside, 1e-3, false);  // no such circle: the smallest instead
  EXPECT_NEAR(half.outer_radius_m, 5e-3, 1e-8);
  EXPECT_NEAR(half.angle, kPi, 1e-3);
  expect_close(curve_point(half, 0.5, 0), {5e-3, 5e-3, 0}, 1e-6);
  const BeamCurve most = arc_through(p, a, inside, 6e-3, true);
  EXPECT_GT(most.angle, kPi);
  expect_close(curve_point(most, 1, 0), a, 1e-14);
  EXPECT_GT(curve_point(most, 0.5, 0).y, 6e-3);
  for (const Vec3& outward : {Vec3{1, 0, 0}, Vec3{0, 0, 0}, Vec3{0, 1, 0}}) {  // along the chord, none, across
    const BeamCurve straight = straight_through(p, a, outward);
    EXPECT_NEAR(norm(straight.radial), 1, 1e-12);
    EXPECT_NEAR(dot(straight.radial, straight.tangential), 0, 1e-12);
  }
}

// The baked surface of a scene, opened.
struct Baked {
  CompileResult result;
  OpenedImage image;
  const Model& model = image.model();
  explicit Baked(const SceneDesc& scene) : result(compile_scene(scene)), image(result.bytes) {
    EXPECT_EQ(image.result().error, ImageError::kNone) << image.result().field;
  }
  Baked(const Baked&) = delete;
  Baked& operator=(const Baked&) = delete;
};

const char* kTool = R"(
[[tool.piece]]
shape = "sphere"
radius_mm = 8
)";
std::string ring_text(const std::string& skeleton, const std::string& law = "circular") {
  return "name = \"r\"\n[body]\nshape = \"ring\"\nradius_mm = 50\nwall_mm = 20\naxis = \"z\"\ntriangles = 800\n"
         "[body.material]\npoisson_ratio = 0.47\n[body.fixed]\nbase_height_mm = 11\n[skeleton]\nlaw = \"" +
         law + "\"\n" + skeleton + kTool;
}
const Baked& ring() {
  static const Baked baked(parse_scene(ring_text("beam_width_mm = 8\n"), "ring.toml"));
  return baked;
}

TEST(DistanceGrid, IsTheDistanceOfTheRing) {
  const Model& surface = ring().model;
  const DistanceGrid grid(surface, 2e-3);
  for (const Vec3& p : {Vec3{0, 90e-3, 0}, Vec3{40e-3, 50e-3, 3e-3}, Vec3{28e-3, 78e-3, -4e-3}, Vec3{0, 50e-3, 0}}) {
    const double exact = closest_surface_point(surface, p, 2e9, -1).signed_distance_m;
    EXPECT_NEAR(grid.at(p), exact, 0.4e-3);  // cell / 5, at the tube's own centre line
  }
  const std::vector<double> wall = wall_thickness_m(surface, grid, 0.1);
  // Across the tube 20 mm, less what 800 facets cut off.
  EXPECT_NEAR(*std::min_element(wall.begin(), wall.end()), 20e-3, 1.5e-3);
}

TEST(SectionCurve, CurvatureOfTheOuterCircle) {
  const Model& surface = ring().model;
  std::int32_t top = 0;
  for (std::int32_t v = 0; v < surface.sizes.n_vertex; ++v)
    if (surface.vertex_m[static_cast<std::size_t>(v)].y > surface.vertex_m[static_cast<std::size_t>(top)].y) top = v;
  std::vector<std::int32_t> first(surface.vertex_m.size(), -1);
  for (std::size_t t = 0; t < surface.triangle.size(); ++t)
    for (const std::int32_t v : surface.triangle[t].vertex)
      first[static_cast<std::size_t>(v)] = static_cast<std::int32_t>(t);
  const SectionLoop loop = trace_section(surface, first, top, {0, 0, 1});
  const SectionCurves curves = curves_between(loop, {50e-3, 50e-3, 0}, 15e-3, 1e-3, {0, 0, 1}, {0, 1, 0});
  ASSERT_TRUE(curves.reaches);
  const int near = curves.way[0].length_m < curves.way[1].length_m ? 0 : 1;
  EXPECT_NEAR(curves.way[near].length_m, 0.5 * kPi * 50e-3, 1e-3);
  EXPECT_NEAR(curves.way[1 - near].length_m, 1.5 * kPi * 50e-3, 2e-3);
  EXPECT_NEAR(curves.way[near].least_curvature_per_m, 20, 1);  // 1 / 50 mm
  // A point of the inner circle is on another loop.
  EXPECT_FALSE(curves_between(loop, {30e-3, 50e-3, 0}, 15e-3, 1e-3, {0, 0, 1}, {0, 1, 0}).reaches);
}

TEST(BeamSelection, EndpointCurvatureLeavesTheBodyAndLeastCurvatureDoesNot) {
  // On an ellipse 40 x 25 mm from (20, 21.65) to (-20, 21.65): the ends curve by 20.02 / m, the middle by 15.625 / m.
  SceneDesc scene = parse_scene(std::string("name = \"e\"\n[body]\nshape = \"ellipsoid\"\nhalf_axes_mm = [40, 25, 25]\n"
                                            "triangles = 5000\n[skeleton]\nlaw = \"none\"\n") +
                                    kTool,
                                "e.toml");
  const Baked body(scene);
  const DistanceGrid grid(body.model, 1e-3);
  const Vec3 tip{20e-3, 46.650635e-3, 0}, anchor{-20e-3, 46.650635e-3, 0};
  const BeamSelector right(body.model, grid, {2e-3, 0.5e-3, false}, 0.1e-3, 2e-3);
  const auto clearance = [&](double curvature) {
    return right.clearance_m(arc_through(tip, anchor, {0, -1, 0}, 1 / curvature + 0.5e-3, false));
  };
  EXPECT_GT(clearance(15.625), -0.1e-3);
  EXPECT_LT(clearance(20.0212), clearance(15.625));
  EXPECT_LT(clearance(20.0212), -0.3e-3);
}

TEST(BeamSelection, NoBeamFitsAWallAsThickAsItself) {
  // 97 % of the wall: no arc has room, and the anchors of the hole cannot be reached.
  const Baked baked(parse_scene(ring_text("beam_width_mm = 18\n"), "ring.toml"));
  const BeamTableReport& beams = baked.result.report.beams;
  EXPECT_GT(beams.count[0], ring().result.report.beams.count[0]);
  EXPECT_THAT(report_text(baked.result.report), testing::HasSubstr("dropped from"));
}

// --- Mechanics
// --------------------------------------------------------------------------------------------------------

BeamBuild example_build(double release_m) { return {{3e6, 0.47}, 10e-3, 10e-3, release_m, false}; }
// The worked arc: a = 30, b = 40 mm, 60 degrees, tip at (b, 0), frame x = r^, y = theta^.
BeamCurve example_arc(double degrees) {
  const double angle = degrees * kPi / 180, b = 40e-3;
  BeamCurve arc;
  arc.path = BeamPath::kArc;
  arc.tip_m = {b, 0, 0};
  arc.anchor_m = {b * std::cos(angle), b * std::sin(angle), 0};
  arc.radial = {1, 0, 0};
  arc.tangential = {0, 1, 0};
  arc.up = {0, 0, 1};
  arc.outer_radius_m = b;
  arc.angle = angle;
  arc.length_m = b * angle;
  return arc;
}

TEST(BeamRows, ReleasedAnchorOfTheWorkedArc) {
  const Eigen::Matrix3d h = release_compliance(example_arc(60), example_build(10e-3));
  const double expected[2][2] = {{0.436706e-3, 0.297449e-3}, {0.469934e-3, 0.383797e-3}};
  // The worked matrix is in the tip's axes; both are the world's here.
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) EXPECT_NEAR(h(i, j), expected[i][j], 6e-10);
  EXPECT_NEAR(h(2, 2), 0.804864e-3, 6e-10);
}

TEST(BeamRows, CurveComplianceIsThatOfBeams) {
  const double l = 60e-3, w = 4e-3, t = 6e-3, e = 3e6, g = e / 2.94;
  const BeamBuild build{{e, 0.47}, w, t, 5e-3, false};
  const Eigen::Matrix3d c = curve_compliance(straight_through({l, 0, 0}, {0, 0, 0}, {0, 1, 0}), build);
  EXPECT_NEAR(c(0, 0), l / (e * w * t), 1e-9 * c(0, 0));
  EXPECT_NEAR(c(1, 1), l * l * l / (3 * e * t * w * w * w / 12) + 1.2 * l / (g * w * t), 1e-9 * c(1, 1));
  EXPECT_NEAR(c(2, 2), l * l * l / (3 * e * w * t * t * t / 12) + 1.2 * l / (g * w * t), 1e-9 * c(2, 2));
  // Against elasticity for a slender arc (h / R = 0.025): beam theory is good to 0.1 %.
  BeamCurve arc = example_arc(80);
  const BeamBuild thin{{e, 0.47}, 1e-3, 10e-3, 5e-3, false};
  const ArcCompliance exact = arc_tip_compliance({39e-3, 40e-3, 10e-3}, thin.material, arc.angle, 40e-3);
  const Eigen::Matrix3d d = curve_compliance(arc, thin);
  EXPECT_NEAR(d(0, 0) / exact.rr_m_per_N, 1, 1e-3);
  EXPECT_NEAR(d(1, 1) / exact.tt_m_per_N, 1, 1e-3);
  EXPECT_NEAR(d(0, 1) / exact.rt_m_per_N, 1, 1e-3);
  EXPECT_NEAR(d(2, 2) / exact.zz_m_per_N, 1, 0.03);  // the torsion's lever arms differ by half the width
}

TEST(BeamRows, StressOfAGentleArcIsThatOfAStraightBeam) {
  const BeamBuild build{{3e6, 0.47}, 4e-3, 6e-3, 5e-3, false};
  const Vec3 tip{30e-3, 0, 0}, anchor{-30e-3, 0, 0};
  const BeamRows arc = beam_rows(arc_through(tip, anchor, {0, -1, 0}, 20.0 * 60e-3, false), build, {0, 1, 0});
  const BeamRows straight = beam_rows(straight_through(tip, anchor, {0, 1, 0}), build, {0, 1, 0});
  // The signs of what bends out of the plane and of the shear follow the frame of the curve: sizes are compared.
  for (int row = 0; row < 6; ++row)
    for (int axis = 1; axis < 3; ++axis) {
      const double scale = straight.stress.row(row).cwiseAbs().maxCoeff();
      EXPECT_NEAR(std::abs(arc.stress(row, axis)), std::abs(straight.stress(row, axis)), 0.03 * scale + 1e-9)
          << row << ' ' << axis;
    }
  EXPECT_GT(arc.stress(0, 1) * straight.stress(0, 1), 0);
  EXPECT_GT(arc.stress(1, 1) * straight.stress(1, 1), 0);
  // An arc is pulled at its outer side, half a width from the middle line: F/S (1 -+ 6/2).
  EXPECT_NEAR(arc.stress(0, 0), -2 * straight.stress(3, 0), 0.02 * straight.stress(3, 0));
  EXPECT_NEAR(arc.stress(1, 0), 4 * straight.stress(3, 0), 0.02 * straight.stress(3, 0));
}

TEST(BeamRows, ContactAtTheAnchorTakesItAlong) {
  const BeamBuild build = example_build(8e-3);
  double before = 0;
  for (const double length : {4e-3, 1e-3, 1e-4, 1e-6, 0.0}) {
    BeamCurve curve = straight_through({length, 0, 0}, {0, 0, 0}, {0, 1, 0});
    if (length == 0) curve.path = BeamPath::kPoint;
    const BeamRows rows = beam_rows(curve, build, {1, 0, 0});
    const double share = (rows.release * rows.stiffness)(0, 0);  // anchor's motion per contact's motion
    EXPECT_GT(share, before);
    EXPECT_LE(share, 1 + 1e-9);
    before = share;
  }
  EXPECT_NEAR(before, 1, 1e-9);
}

// --- A ring, pressed --------------------------------------------------------------------------------------------

// The rest-surface point nearest to p, by the closest-point query instead of the walk.
SurfaceSpot nearest_spot(const Model& model, Vec3 p) {
  const SurfacePoint at = closest_surface_point(model, p, kHuge, -1);
  return locate_from(model, at.closest_w, at.triangle);
}

struct Press {
  BeamTableSkeleton skeleton;
  std::vector<BeamTableAnchor> anchor;
};
Press press_at(const Model& model, Vec3 point, Vec3 force) {
  Press p;
  EXPECT_TRUE(solve_beam_table(model, nearest_spot(model, point), force, p.skeleton));
  for (std::int32_t a = 0; a < p.skeleton.count; ++a) p.anchor.push_back(beam_table_anchor(model, p.skeleton, a));
  return p;
}
// Index of the anchor at p.
std::size_t anchor_at(const Model& model, Vec3 p) {
  for (std::size_t a = 0; a < model.anchor.size(); ++a)
    if (norm(model.anchor[a].position_m - p) < 1e-9) return a;
  ADD_FAILURE() << "no anchor there";
  return 0;
}

TEST(PressedRing, SymmetricPressIsSymmetric) {
  const Model& model = ring().model;
  for (const Vec3& at : {Vec3{0, 100e-3, 0}, Vec3{0, 101e-3, 3e-3}}) {
    const Press p = press_at(model, at, {0, -6, 0});
    for (std::size_t a = 0; a < model.anchor.size(); ++a) {
      const Vec3 q = model.anchor[a].position_m;
      const std::size_t b = anchor_at(model, {-q.x, q.y, q.z});
      const double scale = p.anchor[a].stress.bending_Pa + std::abs(p.anchor[a].stress.axial_Pa) + 1e-3;
      EXPECT_NEAR(p.anchor[a].stress.axial_Pa, p.anchor[b].stress.axial_Pa, 1e-9 * scale);
      EXPECT_NEAR(p.anchor[a].stress.bending_Pa, p.anchor[b].stress.bending_Pa, 1e-9 * scale);
      EXPECT_NEAR(p.anchor[a].stress.shear_Pa, p.anchor[b].stress.shear_Pa, 1e-9 * scale);
      const Vec3 d = p.anchor[a].displacement_w, e = p.anchor[b].displacement_w;
      expect_close(d, {-e.x, e.y, e.z}, 1e-9 * norm(d) + 1e-15);
    }
  }
}

TEST(PressedRing, WalkEndsWhereTheNearestPointIs) {
  const Model& model = ring().model;
  for (std::int32_t v = 0; v < model.sizes.n_vertex; v += 7) {
    // Above the middle of a triangle at this vertex, from a triangle a few edges away.
    for (std::int32_t t = 0; t < model.sizes.n_triangle; ++t) {
      const Triangle& triangle = model.triangle[static_cast<std::size_t>(t)];
      if (triangle.vertex[0] != v) continue;
      Vec3 middle;
      for (const std::int32_t corner : triangle.vertex)
        middle += (1.0 / 3) * model.vertex_m[static_cast<std::size_t>(corner)];
      std::int32_t start = t;
      for (int k = 0; k < 4; ++k) start = model.triangle[static_cast<std::size_t>(start)].adjacent[k % 3];
      const SurfaceSpot walked = locate_from(model, middle, start), nearest = nearest_spot(model, middle);
      ASSERT_TRUE(walked.found);
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(walked.vertex[k], nearest.vertex[k]);
        EXPECT_NEAR(walked.weight[k], 1.0 / 3, 1e-9);
      }
    }
  }
  EXPECT_FALSE(locate_from(model, {0, 0, 0}, -1).found);
  EXPECT_FALSE(locate_from(model, {std::nan(""), 0, 0}, 0).found);
}

TEST(PressedRing, ForcesAddUpAndFallWithDistance) {
  const Model& model = ring().model;
  const Press p = press_at(model, {30e-3, 90e-3, 0}, {-3, -4, 0.5});
  Vec3 sum;
  for (std::int32_t a = 0; a < p.skeleton.count; ++a) sum += p.skeleton.force_w[a];
  expect_close(sum, {-3, -4, 0.5}, 1e-12);
  // The outer anchors by distance from the contact: top, right, left, bottom (36, 45, 89, 95 mm).
  const Vec3 outer[4] = {{0, 100e-3, 0}, {50e-3, 50e-3, 0}, {-50e-3, 50e-3, 0}, {0, 0, 0}};
  double force[4], stress[4];
  for (int k = 0; k < 4; ++k) {
    const std::size_t a = anchor_at(model, outer[k]);
    force[k] = norm(p.skeleton.force_w[a]);
    stress[k] = p.anchor[a].stress.bending_Pa + std::abs(p.anchor[a].stress.axial_Pa);
  }
  EXPECT_GT(std::min(force[0], force[1]), std::max(force[2], force[3]));
  EXPECT_GT(std::min(stress[0], stress[1]), std::max(stress[2], stress[3]));
}

TEST(PressedRing, SidesBulgeTopGoesDownBaseStays) {
  const Model& model = ring().model;
  const Press p = press_at(model, {0, 100e-3, 0}, {0, -6, 0});
  const auto moved = [&](Vec3 q) { return p.anchor[anchor_at(model, q)].displacement_w; };
  EXPECT_GT(moved({50e-3, 50e-3, 0}).x, 0);
  EXPECT_GT(moved({40e-3, 50e-3, 10e-3}).x, 0);
  EXPECT_LT(moved({-50e-3, 50e-3, 0}).x, 0);
  EXPECT_LT(moved({0, 100e-3, 0}).y, 0);
  EXPECT_LT(moved({0, 80e-3, 0}).y, 0);
  EXPECT_EQ(moved({0, 0, 0}), Vec3{});
}

TEST(PressedRing, PaperLawSharesWhatItCan) {
  const Baked paper(parse_scene(ring_text("beam_width_mm = 8\n", "circular_paper"), "ring.toml"));
  const Press p = press_at(paper.model, {20e-3, 95e-3, 0}, {-2, -5, 0});
  Vec3 sum;
  for (std::int32_t a = 0; a < p.skeleton.count; ++a) {
    EXPECT_TRUE(is_finite(p.skeleton.force_w[a]));
    sum += p.skeleton.force_w[a];
  }
  // Both scales together meet a force in the plane of their columns.
  if (!p.skeleton.minimum_norm) {
    EXPECT_LT(norm(sum - Vec3{-2, -5, 0}), 0.5);
  }
}

// Beams end where earlier contacts moved the anchors: body and contact moved by d together share as before, one anchor
// alone changes its beam, and the shares add up. Anchors moved by 0.1 mm change shares by 0.6 % of the largest in the
// mean, 7 % at most (2026-11-25).
TEST(PressedRing, BeamsFollowTheirAnchors) {
  const Model& model = ring().model;
  double worst = 0, mean = 0;
  constexpr int kPresses = 104;
  for (int press = 0; press < kPresses; ++press) {
    const double angle = -2.6 + 0.05 * press;
    const Vec3 out{std::sin(angle), std::cos(angle), 0}, force = -5 * out;
    const SurfaceSpot spot = nearest_spot(model, Vec3{0, 50e-3, 0} + 50e-3 * out);
    Vec3 at;
    for (int k = 0; k < 3; ++k) at += spot.weight[k] * model.vertex_m[static_cast<std::size_t>(spot.vertex[k])];
    std::vector<Vec3> together(model.anchor.size(), Vec3{0.1e-3 * out.y, -0.1e-3 * out.x, 0.05e-3}), apart, none;
    for (std::size_t a = 0; a < model.anchor.size(); ++a) {
      const double turn = 2.4 * static_cast<double>(a);
      apart.push_back(0.1e-3 * Vec3{std::cos(turn) * 0.8, std::sin(turn) * 0.8, a % 2 == 0 ? 0.6 : -0.6});
    }
    BeamTableSkeleton rest, moved, other, alone;
    ASSERT_TRUE(solve_beam_table(model, spot, force, rest));
    ASSERT_TRUE(solve_beam_table(model, spot, force, moved, together));
    ASSERT_TRUE(solve_beam_table(model, locate_from(model, at - together[0], spot.triangle), force, other));
    ASSERT_TRUE(solve_beam_table(model, spot, force, alone, apart));
    double change = 0, largest = 0;
    Vec3 sum;
    for (std::int32_t a = 0; a < rest.count; ++a) {
      EXPECT_EQ(moved.force_w[a], other.force_w[a]);
      change = std::max(change, norm(alone.force_w[a] - rest.force_w[a]));
      largest = std::max(largest, norm(rest.force_w[a]));
      sum += alone.force_w[a];
    }
    expect_close(sum, force, 1e-12);
    worst = std::max(worst, change / largest);
    mean += change / largest / kPresses;
  }
  std::printf("  anchors moved by 0.1 mm: shares change by %.2f %% of the largest at most, %.2f %% in the mean\n",
              100 * worst, 100 * mean);
  EXPECT_GT(worst, 0.005);
  EXPECT_LT(mean, 0.01);
}

// --- Bad input
// --------------------------------------------------------------------------------------------------------

std::string error_of(const std::string& text) {
  return test::refusal_by([&] { compile_scene(parse_scene(text, "s.toml")); });
}

TEST(BeamScenes, MistakesAreNamed) {
  using testing::AllOf;
  using testing::HasSubstr;
  EXPECT_THAT(error_of(ring_text("beam_width_mm = 25\n")),
              AllOf(HasSubstr("s.toml:14"), HasSubstr("skeleton.beam_width_mm"), HasSubstr("thinnest wall"),
                    HasSubstr("lower it")));
  EXPECT_THAT(error_of(ring_text("section_radius_mm = 5\n")),
              AllOf(HasSubstr("section_radius_mm"), HasSubstr("no effect")));
  EXPECT_THAT(error_of(ring_text("beam_width_mm = 5\n", "stiffness")),
              AllOf(HasSubstr("beam_width_mm"), HasSubstr("no effect"), HasSubstr("circular")));
  std::string thick = ring_text("");
  thick.replace(thick.find("wall_mm = 20"), 12, "wall_mm = 48");
  EXPECT_THAT(error_of(thick), AllOf(HasSubstr("body.wall_mm"), HasSubstr("leaves no hole")));
  std::string shape = ring_text("");
  shape.replace(shape.find("axis = \"z\""), 10, "height_mm = 30");
  EXPECT_THAT(error_of(shape), AllOf(HasSubstr("height_mm"), HasSubstr("no effect")));
}

TEST(BeamScenes, SolidBodyGetsStraightBeams) {
  const std::string text =
      std::string("name = \"b\"\n[body]\nshape = \"box\"\ntriangles = 400\n[skeleton]\nlaw = \"circular\"\n") + kTool;
  const Baked box(parse_scene(text, "b.toml"));
  const BeamTableReport& beams = box.result.report.beams;
  std::int64_t all = 0;
  for (const std::int64_t n : beams.count) all += n;
  EXPECT_LT(beams.count[static_cast<int>(BeamPath::kNone)], all / 50);
  EXPECT_GT(beams.count[static_cast<int>(BeamPath::kStraight)], all / 2);
}

}  // namespace
}  // namespace palpate
