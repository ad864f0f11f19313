// Tabulated curves: the monotone interpolation, the reader of measurements and its refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include "config/response/table_bake.h"
#include "config/scene/config_error.h"
#include "rt_core/contact/tips/tip_law.h"

namespace palpate {
namespace {

struct Table {
  CurveTable table;
  bool root = false;
  explicit Table(std::vector<ForceCurve> curves) : table(tabulate(curves)) {}
  TableLaw law(std::size_t a = 0, std::size_t b = 0, std::size_t c = 0, Real u = 1, Real v = 0, Real w = 0) const {
    TableLaw l;
    l.knot = table.knot.data();
    l.knots = static_cast<std::int32_t>(table.knot.size());
    const std::size_t row[3] = {a, b, c};
    for (int k = 0; k < 3; ++k) l.curve[k] = table.row[row[k]].data();
    l.weight[0] = u;
    l.weight[1] = v;
    l.weight[2] = w;
    l.root = root;
    return l;
  }
};

ForceCurve curve_of(std::vector<double> depth, std::vector<double> force) {
  return {false, {}, std::move(depth), std::move(force)};
}

TEST(Pchip, WorkedValues) {
  const Table a({curve_of({0, 1, 2, 4}, {0, 1, 4, 10})});
  const double slope_a[] = {0, 1.5, 3, 3};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(a.table.row[0][k].slope, slope_a[k], 1e-14);
  EXPECT_NEAR(table_at(a.law(), 0.5).force_N, 0.3125, 1e-15);
  EXPECT_NEAR(table_at(a.law(), 1.5).force_N, 2.3125, 1e-15);
  EXPECT_NEAR(table_at(a.law(), 3).force_N, 7, 1e-14);
  EXPECT_NEAR(table_energies(a.law(), 3).energy_J[0], 8.25, 1e-14);
  const Table b({curve_of({0, 0.5, 1, 2, 3}, {0, 1.2, 3.5, 9.7, 17.9})});
  const double slope_b[] = {1.3, 3.15428571, 5.19595142, 7.06111111, 9.2};
  for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(b.table.row[0][k].slope, slope_b[k], 1e-8);
}

// Random monotone data with plateaus and steps: exact at every sample, never falling between, tangent and energy those
// of the force, continued by its tangent.
TEST(Pchip, MonotoneExactAndConsistent) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> step(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> depth{0}, force{0};
    for (int i = 0; i < 12; ++i) {
      depth.push_back(depth.back() + 1e-4 + 1e-3 * step(random));
      force.push_back(force.back() + (step(random) < 0.3 ? 0 : std::pow(10.0, 3 * step(random) - 2)));
    }
    const Table table({curve_of(depth, force)});
    const TableLaw law = table.law();
    for (std::size_t i = 0; i < depth.size(); ++i) EXPECT_EQ(table_at(law, depth[i]).force_N, force[i]);
    double last = 0;
    for (int i = 1; i <= 500; ++i) {
      const double e = 1.2 * depth.back() * i / 500, h = 1e-9;
      const LawPoint point = table_at(law, e);
      EXPECT_GE(point.force_N, last - 1e-12);
      last = point.force_N;
      const double work = (table_energies(law, e + h).energy_J[0] - table_energies(law, e - h).energy_J[0]) / (2 * h);
      EXPECT_NEAR(work, point.force_N, 1e-4 * force.back());
    }
  }
}

// Curves with different depths share their knots without changing.
TEST(Pchip, UnionOfKnotsIsLossless) {
  const ForceCurve a = curve_of({0, 1, 2, 4}, {0, 1, 4, 10}), b = curve_of({0, 0.7, 3.1}, {0, 2, 2.5});
  const Table both({a, b}), only_a({a}), only_b({b});
  EXPECT_EQ(both.table.knot.size(), 6u);
  for (int i = 0; i <= 500; ++i) {
    const double e = 0.01 * i;
    EXPECT_NEAR(table_at(both.law(0, 0, 0), e).force_N, table_at(only_a.law(), e).force_N, 1e-13);
    EXPECT_NEAR(table_at(both.law(1, 1, 1), e).force_N, table_at(only_b.law(), e).force_N, 1e-13);
    EXPECT_NEAR(table_energies(both.law(1, 1, 1), e).energy_J[1], table_energies(only_b.law(), e).energy_J[0], 1e-13);
  }
  // Area coordinates (.5, .2, .3) mix 5, 6 and 7 N to 5.8 N (Mahvash & Hayward 2002, eq. 3).
  const Table mix({curve_of({0, 1}, {0, 5}), curve_of({0, 1}, {0, 6}), curve_of({0, 1}, {0, 7})});
  EXPECT_NEAR(table_at(mix.law(0, 1, 2, 0.5, 0.2, 0.3), 1).force_N, 5.8, 1e-14);
  for (const double depth : {0.0, -1.0, std::nan("")}) EXPECT_EQ(table_at(mix.law(), depth).force_N, 0);
}

// Knots that are roots of depths carry Hertz's law without error: it is a cubic there.
TEST(Pchip, RootTableHoldsHertzExactly) {
  Table table({curve_of({0, 0.5, 1, 2}, {0, 0.125, 1, 8})});
  table.root = true;
  double energy = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double s = table.table.knot[k];
    energy = 0.4 * std::pow(s, 5);
    table.table.row[0][k] = {s * s * s, 3 * s * s, energy};
  }
  for (const double e : {1e-6, 0.1, 0.3, 1.7, 3.9, 5.0}) {
    const LawPoint point = table_at(table.law(), e);
    const bool inside = e <= 4;
    EXPECT_NEAR(point.force_N, inside ? std::pow(e, 1.5) : 8 + 3 * (e - 4), 1e-14 * (1 + point.force_N));
    EXPECT_NEAR(point.tangent_N_per_m, inside ? 1.5 * std::sqrt(e) : 3, 1e-11);
    const double edge = 0.4 * 32;
    EXPECT_NEAR(table_energies(table.law(), e).energy_J[0],
                inside ? 0.4 * std::pow(e, 2.5) : edge + 8 * (e - 4) + 1.5 * (e - 4) * (e - 4), 1e-13);
  }
}

class CurveFile : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    // Tests run side by side: a file of its own for each.
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    path_ = (std::filesystem::temp_directory_path() / ("palpate_" + name + ".csv")).string();
    std::ofstream(path_) << text;
    return path_;
  }
  void TearDown() override { std::filesystem::remove(path_); }
  void expect_refused(const std::string& text, int line, const std::string& words) {
    try {
      read_curves(write(text), false);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const ConfigError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find(line > 0 ? path_ + ":" + std::to_string(line) + ":" : path_ + ":"), std::string::npos)
          << what;
      EXPECT_NE(what.find(words), std::string::npos) << what;
    }
  }
  std::string path_;
};

TEST_F(CurveFile, ReadsOneAndSeveralPresses) {
  const std::vector<ForceCurve> one = read_curves(write("# rubber\ndepth_mm,force_N\n0,0\n1, 2.5\r\n2,7\n"), false);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_FALSE(one[0].placed);
  EXPECT_EQ(one[0].depth_m, (std::vector<double>{0, 1e-3, 2e-3}));
  EXPECT_EQ(one[0].force_N, (std::vector<double>{0, 2.5, 7}));
  const std::vector<ForceCurve> two =
      read_curves(write("x_mm,y_mm,z_mm,depth_mm,force_N\n1,2,3,0,0\n1,2,3,1,4\n5,2,3,0,0\n5,2,3,2,1\n"), false);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_TRUE(two[1].placed);
  EXPECT_EQ(two[1].position_m, (Vec3{5e-3, 2e-3, 3e-3}));
}

TEST_F(CurveFile, RefusesWithFileLineAndRemedy) {
  expect_refused("depth_mm,force_N\n0,0\n2,1\n1,2\n", 4, "sort the rows");
  expect_refused("depth_mm,force_N\n0,0\n1,1\n1,2\n", 4, "average repeated depths");
  expect_refused("depth_mm,force_N\n0,0\n1,2\n2,1.9\n", 4, "contact.table.smooth");
  expect_refused("depth_mm,force_N\n0.1,0\n1,2\n", 2, "first row must be 0,0");
  expect_refused("depth_mm,force_N\n0,0.2\n1,2\n", 2, "subtract the force before contact");
  expect_refused("depth_mm,force_N\n0,0\n", 2, "at least one more");
  expect_refused("depth_mm,force_N\n0,0\n1,x\n", 3, "not a number");
  expect_refused("depth_mm,force_N\n0,0\n1,nan\n", 3, "out of range");
  expect_refused("depth_mm,force_N\n0,0\n1,2,3\n", 3, "3 fields");
  expect_refused("d,f\n0,0\n", 1, "unknown header");
  expect_refused("", 0, "empty");
  expect_refused("depth_mm,force_N\n", 0, "no rows");
  expect_refused("x_mm,y_mm,z_mm,depth_mm,force_N\n0,0,0,0,0\n0,0,0,1,1\n1,0,0,0,0\n1,0,0,1,1\n0,0,0,2,2\n", 6,
                 "keep its rows together");
  EXPECT_THROW(read_curves("/nonexistent.csv", false), ConfigError);
}

TEST_F(CurveFile, PoolsFallingRowsOnRequest) {
  const std::vector<ForceCurve> pooled =
      read_curves(write("depth_mm,force_N\n0,0\n1,2\n2,1\n3,5\n4,4\n5,3\n6,9\n"), true);
  EXPECT_EQ(pooled[0].force_N, (std::vector<double>{0, 1.5, 1.5, 4, 4, 4, 9}));
}

TEST(Tabulate, RefusesTooManyDepths) {
  std::vector<double> depth, force;
  for (int i = 0; i <= kMaxResponseKnots; ++i) {
    depth.push_back(i);
    force.push_back(i);
  }
  EXPECT_THROW(tabulate({curve_of(depth, force)}), ConfigError);
}

}  // namespace
}  // namespace palpate
