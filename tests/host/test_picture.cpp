// The renderer: areas it must cover, what hides what, and files others can read.
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "sim_host/bake/scene_model.h"
#include "sim_host/tick_memory.h"
#include "sim_host/view/picture.h"
#include "sim_host/view/png_file.h"

namespace palpate {
namespace {

Camera front_camera() {
  Camera camera;
  camera.eye_m = {0, 0, 1};
  camera.target_m = {0, 0, 0};
  camera.up = {0, 1, 0};
  camera.vertical_fov_rad = 2 * std::atan(0.25);  // the plane z = 0 shows half a metre of height
  return camera;
}

int covered(const Layer& layer, std::int32_t material) {
  int count = 0;
  for (int y = 0; y < layer.height(); ++y) {
    for (int x = 0; x < layer.width(); ++x) count += layer.at(x, y).material == material ? 1 : 0;
  }
  return count;
}

TEST(MeshRaster, ASphereCoversItsSilhouette) {
  const Projection projection(front_camera(), 400, 400);
  Layer layer(400, 400);
  const double r = 0.1;
  layer.draw({sphere_mesh({}, r), projection, 3});
  // The silhouette of a sphere at distance 1 is a circle of tan(asin r) metres at that distance; 800 pixels per metre.
  const double radius = 800 * std::tan(std::asin(r));
  EXPECT_NEAR(covered(layer, 3), kPi * radius * radius, 0.01 * kPi * radius * radius);  // 64 sectors lose 0.2 %
  const Surfel& middle = layer.at(200, 200);
  EXPECT_NEAR(static_cast<double>(middle.depth_m), 1 - r, 1e-3);
  EXPECT_GT(middle.normal[2], 0.99f);
  EXPECT_EQ(layer.at(5, 5).material, -1);
}

TEST(MeshRaster, TheNearerSurfaceWinsInAnyOrder) {
  const Projection projection(front_camera(), 200, 200);
  const RenderMesh nearer = sphere_mesh({{0, 0, 0.2}, {}}, 0.05), farther = sphere_mesh({{0, 0, -0.2}, {}}, 0.1);
  Layer a(200, 200), b(200, 200);
  a.draw({nearer, projection, 1});
  a.draw({farther, projection, 2});
  b.draw({farther, projection, 2});
  b.draw({nearer, projection, 1});
  EXPECT_EQ(a.at(100, 100).material, 1);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) ASSERT_EQ(a.at(x, y).material, b.at(x, y).material);
  }
  EXPECT_GT(covered(a, 2), 0);  // the larger one shows around it
}

// A picture is drawn a band of rows at a time; what is above and below a band falls away.
TEST(MeshRaster, BandsShowWhatTheWholeShows) {
  const Projection projection(front_camera(), 200, 200);
  const PlacedMesh sphere(sphere_mesh({{0.01, 0.02, 0}, {}}, 0.09), projection, 1);
  Layer whole(200, 200), band(200, 200, 33);
  whole.draw(sphere);
  for (int y = 0; y < 200; ++y) {
    if (y % 32 == 0) {
      band.begin(y);
      band.draw(sphere);
    }
    for (int x = 0; x < 200; ++x) {
      ASSERT_EQ(band.at(x, y).material, whole.at(x, y).material);
      ASSERT_EQ(band.at(x, y).depth_m, whole.at(x, y).depth_m);
    }
  }
  EXPECT_GT(covered(whole, 1), 4000);  // 36 pixels in radius
}

TEST(MeshRaster, ValuesAreInterpolatedInPerspective) {
  // A strip from z = 0.5 (value 0) to z = -3 (value 1): at its middle pixel row between the two ends the value follows
  // depth, not the screen.
  RenderMesh strip;
  strip.position_m = {{-0.1, -0.05, 0.5}, {0.1, -0.05, 0.5}, {0.1, -0.05, -3}, {-0.1, -0.05, -3}};
  strip.normal.assign(4, {0, 1, 0});
  strip.value = {0, 0, 1, 1};
  strip.triangle = {{0, 1, 2}, {0, 2, 3}};
  const Projection projection(front_camera(), 400, 400);
  Layer layer(400, 400);
  layer.draw({strip, projection, 0});
  int seen = 0;
  for (int y = 0; y < 400; ++y) {
    const Surfel& s = layer.at(200, y);
    if (s.material < 0) continue;
    EXPECT_NEAR(static_cast<double>(s.value), (static_cast<double>(s.depth_m) - 0.5) / 3.5, 1e-5);
    ++seen;
  }
  EXPECT_GT(seen, 20);
}

TEST(MeshRaster, NothingBehindTheEyeIsDrawn) {
  const Projection projection(front_camera(), 100, 100);
  Layer layer(100, 100);
  layer.draw({sphere_mesh({{0, 0, 2}, {}}, 0.3), projection, 1});
  layer.draw({RenderMesh{}, projection, 1});
  EXPECT_EQ(covered(layer, 1), 0);
}

// Every vertex of a rounded body lies on its offset surface, with the outward normal.
TEST(MeshRaster, PiecesHaveTheirSize) {
  const Pose pose{{1, 2, 3}, rotation_between({0, 0, 1}, {1, 0, 0})};
  const std::array<Point2, 2> capsule{{{0, -0.03}, {0, 0.03}}};
  const RenderMesh mesh = revolved_mesh(pose, capsule, 0.01);
  for (std::size_t i = 0; i < mesh.position_m.size(); ++i) {
    const Vec3 p = inverse_transform(pose, mesh.position_m[i]);
    const Vec3 q{p.x, p.y, p.z - clamp_to(p.z, -0.03, 0.03)};
    EXPECT_NEAR(norm(q), 0.01, 1e-12);
    EXPECT_GT(dot(rotate(conjugate(pose.orientation), mesh.normal[i]), q), 0.0099);
  }
  const Vec3 corners[] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  for (const Vec3 p : hull_mesh({}, corners, 0.1).position_m) {
    double nearest = 1e9;
    for (const Vec3 c : corners) nearest = std::min(nearest, norm(p - c));
    EXPECT_NEAR(nearest, 0.1, 1e-12);
  }
}

TEST(Picture, ColourMapIsLightAtZeroAndDarkAtTheTop) {
  double last = 10;
  for (int k = 0; k <= 20; ++k) {
    const Colour c = map_colour(k / 20.0);
    const double lightness =
        0.2126 * static_cast<double>(c.r) + 0.7152 * static_cast<double>(c.g) + 0.0722 * static_cast<double>(c.b);
    EXPECT_LT(lightness, last);
    last = lightness;
  }
  EXPECT_EQ(map_colour(-1), map_colour(0));
  EXPECT_EQ(map_colour(2), map_colour(1));
}

std::string scene_path() { return std::string(PALPATE_SOURCE_DIR) + "/config/scenes/ellipsoid_mallet.toml"; }

TEST(Picture, RefinementKeepsTheShape) {
  const SceneModel scene(scene_path());
  const auto state = make_state(scene.model());
  reset(*state);
  const DeformedSurface fine = refined_surface(scene.model(), *state, 50'000);
  EXPECT_EQ(fine.triangle.size(), scene.model().triangle.size() * 16);
  EXPECT_EQ(fine.position_m.size(), fine.triangle.size() / 2 + 2);  // closed: Euler's formula
  for (std::size_t i = 0; i < fine.position_m.size(); ++i) {
    const Vec3 p = fine.position_m[i] - Vec3{0, 0.03, 0};
    const double q = p.x * p.x / 1.6e-3 + p.y * p.y / 9e-4 + p.z * p.z / 6.25e-4;
    EXPECT_NEAR(q, 1, 4e-3);  // flat facets of this mesh are 1.5e-2 off
    EXPECT_EQ(fine.displacement_m[i], Vec3{});
  }
}

// The lids of a cylinder stay flat and its rims round, and no normal averages over a rim.
TEST(Picture, RefinementKeepsCreases) {
  const SceneModel scene(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/grasp_cylinder_2.toml");
  const auto state = make_state(scene.model());
  reset(*state);
  state->tool_w.position_m = {-1, 0, 0};  // the palm, which flattens what lies against it, out of the way
  const DeformedSurface fine = refined_surface(scene.model(), *state, 50'000);
  EXPECT_EQ(fine.position_m.size(), fine.triangle.size() / 2 + 2);
  ASSERT_EQ(fine.corner_normal.size(), fine.triangle.size());
  for (std::size_t t = 0; t < fine.triangle.size(); ++t) {
    Vec3 p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] = fine.rest_m[static_cast<std::size_t>(fine.triangle[t][k])];
    const Vec3 face = unit_or(cross(p[1] - p[0], p[2] - p[0]), {});
    const bool lid = std::abs(face.y) > 0.5;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 n = fine.corner_normal[t][k];
      if (lid) {
        EXPECT_NEAR(p[k].y, p[k].y > 0.06 ? 0.12 : 0, 1e-12);
        EXPECT_NEAR(std::abs(n.y), 1, 1e-9);
      } else {
        EXPECT_NEAR(std::hypot(p[k].x, p[k].z), 0.022, 2e-6);  // chords of the model's mesh sag by 6e-5 m
        EXPECT_NEAR(n.y, 0, 1e-9);
      }
    }
  }
}

TEST(Picture, EverythingIsInTheFrameBesideTitleAndLegend) {
  for (const char* name : {"ellipsoid_mallet", "grasp_sphere_5", "snap_in"}) {
    const SceneModel scene(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/" + name + ".toml");
    const auto state = make_state(scene.model());
    reset(*state);
    const Vec3 arrow{0.05, 0.12, -0.03};
    const Camera camera = default_camera(scene.model(), *state, std::span<const Vec3>(&arrow, 1), 4.0 / 3);
    const Projection projection(camera, 1200, 900);
    std::vector<Vec3> points(scene.model().vertex_m.begin(), scene.model().vertex_m.end());
    points.push_back(arrow);
    double left = 1200, right = 0, top = 900, bottom = 0;
    for (const Vec3 v : points) {
      const Vec3 at = projection(v);
      left = std::min(left, at.x), right = std::max(right, at.x);
      top = std::min(top, at.y), bottom = std::max(bottom, at.y);
    }
    EXPECT_GE(left, 0) << name;
    EXPECT_LE(right, 1076) << name;  // where the word "displacement" begins
    EXPECT_GE(top, 95) << name;      // below the title's two lines
    EXPECT_LE(bottom, 900) << name;
  }
}

TEST(Picture, SceneIsDrawnWithBodyToolAndLegend) {
  const SceneModel scene(scene_path());
  const auto state = make_state(scene.model());
  reset(*state);
  state->tool_w.position_m = {0, 0.08, 0};
  PictureOptions options;
  options.width = 240;
  options.height = 180;
  const Canvas canvas = render_scene(scene.model(), *state, refined_surface(scene.model(), *state, 20'000), options);
  ASSERT_EQ(canvas.width(), 240);
  // The body (sand) is in the middle, the background near white at the top left, the legend's dark end at the right.
  const Colour middle = canvas.pixel(120, 120), corner = canvas.pixel(2, 2);
  EXPECT_GT(middle.r, middle.b + 0.03f);
  EXPECT_GT(corner.b, 0.95f);
  double darkest = 1;
  for (int y = 0; y < 180; ++y) {
    for (int x = 215; x < 230; ++x) darkest = std::min(darkest, static_cast<double>(canvas.pixel(x, y).g));
  }
  EXPECT_LT(darkest, 0.2);
}

TEST(Picture, PngReadsBackAsWritten) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("palpate_picture_" + std::to_string(getpid()) + ".png");
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 7 * 5 * 3; ++i) pixels.push_back(static_cast<std::uint8_t>(i * 7));
  write_png(path.string(), 7, 5, pixels);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0);
  EXPECT_EQ(image.width, 7u);
  EXPECT_EQ(image.height, 5u);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> back(pixels.size());
  ASSERT_NE(png_image_finish_read(&image, nullptr, back.data(), 0, nullptr), 0);
  EXPECT_EQ(back, pixels);
  std::filesystem::remove(path);
  EXPECT_THROW(write_png("/nonexistent_folder/x.png", 7, 5, pixels), std::runtime_error);
  EXPECT_THROW(write_png(path.string(), 8, 5, pixels), std::runtime_error);
}

}  // namespace
}  // namespace palpate
