// Response tables that the baker presses itself, by finite elements, with the scene's own tool and body.
#pragma once

#include <string>
#include <vector>

#include "config/response/press_places.h"
#include "config/response/press_series.h"
#include "config/response/table_bake.h"
#include "config/scene/progress.h"

namespace palpate {

// Force curves of all places of a body's surface.
struct PressTable {
  PressPlaces places;
  PressSeries top;
  PlaceCompliance compliance;
  CurveTable table;  // one row per place, cubics in the root of the depth
  double press_s = 0, place_s = 0;
};
// At the top the curve is that of large-strain presses; elsewhere the travel at the same force changes by what the
// tip's own law does with the body's curvature there, and by the body's linear compliance there less that at the top.
// Throws ConfigError naming the scene's key.
PressTable press_table(const SceneDesc& scene, const std::vector<Vec3>& vertex_m, const Progress& progress = {});

// Exact values and slopes of one place's curve at the knots (roots of depths, from 0): travel = local(F) + far(F) +
// extra F. Throws ConfigError where the travel does not grow with the force.
std::vector<ResponseKnot> press_row(const LocalLaw& local, const FarSeries& far, double extra_m_per_N,
                                    const std::vector<double>& knot);

// What the report says of it.
std::vector<std::string> describe(const PressTable& table);

}  // namespace palpate
