// Pose tables: what is read, and that every mistake is named with its line.
#include <gtest/gtest.h>

#include <sstream>

#include "sim_host/press/pose_csv.h"

namespace palpate {
namespace {

std::vector<TimedPose> read(const std::string& text) {
  std::istringstream stream(text);
  return read_poses(stream, "poses.csv", 1e-3);
}

TEST(PoseCsv, ReadsColumnsInAnyOrder) {
  const auto poses = read("# a comment\r\nz_mm, x_mm ,y_mm,time_s\r\n3,1,2,0.5\r\n\r\n-3e0,-1,-2.5,0.75\r\n");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].time_s, 0.5);
  EXPECT_EQ(poses[0].tool_w.position_m, (Vec3{1e-3, 2e-3, 3e-3}));
  EXPECT_EQ(poses[0].tool_w.orientation, Quat{});
  EXPECT_EQ(poses[1].tool_w.position_m, (Vec3{-1e-3, -2.5e-3, -3e-3}));
}

TEST(PoseCsv, RowsAreTicksWithoutTimes) {
  const auto poses = read("x_mm,y_mm,z_mm\n0,0,0\n0,0,1\n0,0,2\n");
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_DOUBLE_EQ(poses[2].time_s, 2e-3);
}

TEST(PoseCsv, RotationVectorAndQuaternionAgree) {
  const auto a = read("x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg\n0,0,0,0,90,0\n");
  const auto b = read("x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,0,0.70710678118654752,0,0.70710678118654752,0\n");
  const Vec3 x{1, 0, 0};
  EXPECT_NEAR(norm(rotate(a[0].tool_w.orientation, x) - Vec3{0, 0, -1}), 0, 1e-15);
  EXPECT_NEAR(norm(rotate(b[0].tool_w.orientation, x) - Vec3{0, 0, -1}), 0, 1e-15);
}

struct Mistake {
  const char* text;
  const char* message;
};

TEST(PoseCsv, MistakesAreNamedWithTheirLine) {
  const Mistake mistakes[] = {
      {"", "poses.csv: empty"},
      {"x_mm,y_mm,z_mm\n", "no rows after the header"},
      {"x_mm,y_mm\n1,2\n", "poses.csv:1: column z_mm is missing"},
      {"x_m,y_m,z_m\n1,2,3\n", "poses.csv:1: unknown column 'x_m'; allowed are time_s, x_mm"},
      {"1,2,3\n", "poses.csv:1: unknown column '1'"},
      {"x_mm,y_mm,z_mm,x_mm\n1,2,3,4\n", "poses.csv:1: column x_mm appears twice"},
      {"x_mm,y_mm,z_mm,rx_deg\n1,2,3,4\n", "poses.csv:1: column ry_deg is missing"},
      {"x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg,qw,qx,qy,qz\n1,2,3,0,0,0,1,0,0,0\n", "both a rotation vector and a quat"},
      {"x_mm,y_mm,z_mm\n1,2,3\n1,2\n", "poses.csv:3: 2 values, but the header names 3 columns"},
      {"x_mm,y_mm,z_mm\n1,2,3\n1,abc,3\n", "poses.csv:3: y_mm: 'abc' is not a number"},
      {"x_mm,y_mm,z_mm\n1,2,\n", "poses.csv:2: z_mm: '' is not a number"},
      {"x_mm,y_mm,z_mm\n1,2,3mm\n", "poses.csv:2: z_mm: '3mm' is not a number"},
      {"x_mm,y_mm,z_mm\n1,nan,3\n", "poses.csv:2: y_mm: 'nan' is not finite"},
      {"x_mm,y_mm,z_mm\n1,2,inf\n", "poses.csv:2: z_mm: 'inf' is not finite"},
      {"x_mm,y_mm,z_mm\n1,2,1e400\n", "poses.csv:2: z_mm: '1e400' is not a number"},
      {"x_mm,y_mm,z_mm\n1,2,3e8\n", "poses.csv:2: z_mm: 3e+08 is outside -1e5 to 1e5 mm; check the unit"},
      {"time_s,x_mm,y_mm,z_mm\n0,1,2,3\n0,1,2,3\n", "poses.csv:3: time_s: 0 does not come after 0"},
      {"x_mm,y_mm,z_mm,qw,qx,qy,qz\n1,2,3,1,1,0,0\n",
       "poses.csv:2: qw, qx, qy, qz: length 1.41421; a rotation has len"},
  };
  for (const Mistake& mistake : mistakes) {
    try {
      read(mistake.text);
      ADD_FAILURE() << "accepted: " << mistake.text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(mistake.message), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(read_pose_file("/nonexistent_folder/poses.csv", 1e-3), std::runtime_error);
}

TEST(PoseCsv, ResamplingIsLinearAndKeepsTheEnds) {
  const auto poses =
      read("time_s,x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg\n0,0,0,0,0,0,0\n0.01,10,0,0,0,0,60\n0.02,10,5,0,0,0,60\n");
  const auto fine = resample(poses, 1e-3);
  ASSERT_EQ(fine.size(), 21u);
  EXPECT_NEAR(fine[5].tool_w.position_m.x, 5e-3, 1e-12);
  const Vec3 turned = rotate(fine[5].tool_w.orientation, {1, 0, 0});
  EXPECT_NEAR(turned.x, std::sqrt(0.75), 1e-9);
  EXPECT_NEAR(turned.y, 0.5, 1e-9);
  EXPECT_NEAR(fine[20].tool_w.position_m.y, 5e-3, 1e-12);
  EXPECT_NEAR(fine[15].tool_w.position_m.y, 2.5e-3, 1e-12);
  EXPECT_TRUE(resample({}, 1e-3).empty());
  EXPECT_EQ(resample(std::span(poses).first(1), 1e-3).size(), 1u);
}

TEST(PoseCsv, ScriptedPathStartsAndEndsAtItsPoints) {
  PathDesc path;
  path.point = {{0, {0, 0.09, 0}, {}}, {0.5, {0.01, 0.06, 0}, {0, 0, 0.1}}};
  const auto poses = scripted_poses(path, 1e-3);
  ASSERT_EQ(poses.size(), 501u);
  EXPECT_EQ(poses.front().tool_w.position_m, (Vec3{0, 0.09, 0}));
  EXPECT_NEAR(norm(poses.back().tool_w.position_m - Vec3{0.01, 0.06, 0}), 0, 1e-12);
}

}  // namespace
}  // namespace palpate
