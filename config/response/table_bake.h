// Force curves over depth, measured or computed, and how they become the image's tables.
#pragma once

#include <string>
#include <vector>

#include "config/response/tip_bake.h"

namespace palpate {

// One press: force over depth, from (0, 0), depths ascending, forces never falling. `placed`: made at position_m,
// world.
struct ForceCurve {
  bool placed = false;
  Vec3 position_m;
  std::vector<double> depth_m;
  std::vector<double> force_N;
};

// Reads a CSV of one press (columns depth_mm, force_N) or of several (x_mm, y_mm, z_mm before them; the rows of one
// press follow one another). Lines that start with # are comments. `smooth`: forces that fall are made monotone by
// pooling (Ayer et al. 1955) instead of refused. Throws ConfigError naming file and line.
std::vector<ForceCurve> read_curves(const std::string& path, bool smooth);

// Slopes of the monotone C1 cubic through (x, y), x ascending: Fritsch & Butland 1984 inside, three-point formulas,
// limited, at the ends. At least two points.
std::vector<double> pchip_slopes(const std::vector<double>& x, const std::vector<double>& y);

// Fills the energies at the knots: exact integrals of the cubics over the depth, which is the knots' variable or, in a
// root table, its square.
void integrate_curve(const std::vector<double>& knot, bool root, std::vector<ResponseKnot>& row);

// All curves on the union of their depths, on which each is still the same cubic: knots, and one row per curve.
struct CurveTable {
  std::vector<double> knot;
  std::vector<std::vector<ResponseKnot>> row;
};
// Throws ConfigError when the union has more than kMaxResponseKnots depths. `root`: cubics in the root of the depth,
// with zero slope at zero, for computed presses that start like Hertz' law.
CurveTable tabulate(const std::vector<ForceCurve>& curves, bool root = false);

// Fills the tables of a scene with contact.law = "table".
void bake_table(const SceneDesc& scene, ImageContents& image, ResponseReport& report,
                std::vector<std::string>& warnings);

}  // namespace palpate
