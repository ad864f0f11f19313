// The scales of a view: colours of the body, lengths of force arrows, the bar that says how long a millimetre is.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"
#include "sim_host/view/anchors.h"
#include "sim_host/view/deformed_surface.h"

namespace palpate {

// A round length of 1, 2 or 5 times a power of ten, the largest that is not above `most`; 0 unless that is positive.
double round_below(double most);

// What the body's colours show.
enum class SurfaceColour {
  kDisplacement,
  kPressure,  // of the contacts
  kStress,    // at the skeleton's anchors, where its beams are clamped
};
inline constexpr int kSurfaceColours = 3;
const std::map<std::string, SurfaceColour>& surface_colours();
// Whether the model knows it. What it does not is not drawn, and the legend says so.
bool solves(const Model& model, SurfaceColour shown);
// What a body's colours are, for the legend: displacement that the model computes everywhere, or a law of shape drawn
// around the contact that it computes; where a pressure comes from.
const char* colour_meaning(const Model& model, SurfaceColour shown);

// Colours run from 0 to `top`, which has a tick; contour lines stand at the ticks.
struct ColourScale {
  SurfaceColour shown = SurfaceColour::kDisplacement;
  double top = 1e-3;  // m or Pa
  double unit = 1e-3;
  const char* name = "displacement";
  const char* unit_name = "mm";
  std::vector<double> tick;  // in that unit
};
// For a largest value (m or Pa); `fixed`: that is the top as it is, otherwise it is rounded up to the next tick.
ColourScale colour_scale(SurfaceColour shown, double largest, bool fixed);

// Of a vertex, and the largest of a body, m or Pa; 0 where there is none.
double surface_value(const DeformedSurface& surface, std::size_t vertex, SurfaceColour shown);
// Of all vertices, as they are coloured: evened out between neighbours, by no more than kEvenShare of the scale, which
// no eye reads off a legend. Where a body moves nearly as a whole its values are as rough as they are different, and a
// contour line ran zigzag from vertex to vertex.
inline constexpr double kEvenShare = 0.01;
std::vector<double> drawn_values(const DeformedSurface& surface, const ColourScale& scale);
double largest_value(const DeformedSurface& surface, const AnchorField& anchors, SurfaceColour shown);

// Arrows of one scale: a newton has the same length wherever it is drawn, and for the whole run.
struct ForceScale {
  double m_per_N = 0;
  double reference_N = 0;  // round: of the arrow in the legend
};
// `largest_N`: the run's largest force of one region; its arrow is as long as 0.45 of the body's extent.
ForceScale force_scale(double largest_N, double body_size_m);

// A force to draw: from where it acts, on the tool.
struct DrawnForce {
  Vec3 tail_w, force_N;
  Vec3 friction_N;  // its tangential part
};
// What the body does to the tool in all, of every region in contact, and what a picture's first line says of it: where
// there are several, that the number is their sum, which no arrow has.
struct ForceSum {
  Vec3 sum_N;
  double largest_N = 0, depth_m = 0;
  int regions = 0;
};
ForceSum force_sum(const State& state);
std::string force_words(const ForceSum& sum);
// Of each region in contact, the largest first; none below a hundredth of it.
std::vector<DrawnForce> drawn_forces(const State& state);

}  // namespace palpate
