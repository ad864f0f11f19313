#include "config/response/press_bake.h"

#include <algorithm>
#include <cmath>

#include "config/fem/pair_fit.h"
#include "config/fem/series_fit.h"
#include "config/response/press_shape.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"
#include "rt_core/contact/tips/tip_law.h"

namespace palpate {

namespace {

// Elements under the tool, in the order they are tried: the large-strain solver now and then finds no equilibrium on
// one mesh that it finds on another.
constexpr int kElements[] = {12, 10, 16};
// Where a press is read for the second order of a pair, as shares of its range.
constexpr double kPairShares[] = {0.25, 0.5, 0.75, 1};
[[noreturn]] void fail(const SceneDesc& scene, const std::string& key, const std::string& what) {
  throw ConfigError(scene.source.where(key) + ": " + what);
}

}  // namespace

FarFieldFit fit_far_field(const SceneDesc& scene, std::size_t piece, const TipDesc& tip) {
  const std::string key = "contact.series.c0_mm_per_N";
  std::vector<FactorKnot> factor;
  const TipLaw law = make_tip_law(tip, factor);
  const LocalLaw local{&law, law.first_factor < 0 ? nullptr : factor.data()};
  const auto depth_of =
      fem::inverse_of([local](double depth) { return local_at(local, depth).force_N; }, tip.depth_max_m);
  const fem::PressBody body = pressed_body(scene, key);
  const fem::RigidTool tool = pressed_tool(scene.piece[piece], tip.indenter, tip.depth_max_m);
  std::string why;
  for (const int elements : kElements) {
    try {
      const fem::SeriesCoefficients c =
          fem::bake_series(body, tool, depth_of, tip.depth_max_m, press_meshing(body, tool, tip.depth_max_m, elements))
              .coefficients;
      return {c.c0_m_per_N, c.c1_m_per_N2};
    } catch (const ConfigError& error) {
      why = error.what();
    }
  }
  fail(scene, key, why + "; lower contact.max_depth_mm or give numbers");
}

namespace {

// One tool presses, the other touches the sunken top `apart_m` away.
fem::TouchFit press_beside(const fem::PressBody& body, const fem::RigidTool& tool, const fem::RigidTool& other,
                           double depth_max_m, double apart_m) {
  std::vector<double> depths_m;
  for (const double share : kPairShares) depths_m.push_back(share * depth_max_m);
  const fem::PressMeshing meshing = press_meshing(body, tool, depth_max_m, kElements[0]);
  const fem::PressCurve large =
      fem::press_as_far_as_possible(body, tool, fem::StrainLaw::kNeoHookean, depths_m, meshing);
  if (large.points.size() < 2) throw ConfigError("press: no equilibrium at half the depth");
  std::vector<fem::LoadPoint> touch;
  for (const fem::PressPoint& p : large.points)
    touch.push_back({fem::touch_depth_m(fem::top_line(large.mesh, p.u_m), other, apart_m), p.force_N});
  return fem::fit_touch(touch);
}

// The widest contact of a press, from the mesh made for it.
double contact_radius_m(const fem::PressBody& body, const fem::RigidTool& tool, double depth_max_m) {
  return press_meshing(body, tool, depth_max_m, kElements[0]).fine_extent_m / 1.25;
}

}  // namespace

PairFit fit_pair_far_field(const SceneDesc& scene, std::size_t pair, double apart_m, const std::vector<TipDesc>& tip) {
  const std::string key = "contact.pair[" + std::to_string(pair) + "].c_mm_per_N";
  const fem::PressBody body = pressed_body(scene, key);
  if (body.kind != fem::PressBody::Kind::kBlock)
    fail(scene, key, "can be computed on a level top only: a standing cylinder or a box; give numbers instead");
  const auto a = static_cast<std::size_t>(scene.pair[pair].piece_a),
             b = static_cast<std::size_t>(scene.pair[pair].piece_b);
  const double depth = tip[a].depth_max_m;
  const fem::RigidTool first = pressed_tool(scene.piece[a], tip[a].indenter, depth),
                       second = pressed_tool(scene.piece[b], tip[b].indenter, depth);
  const double nearest = contact_radius_m(body, first, depth) + contact_radius_m(body, second, depth),
               farthest = body.outer_radius_m - contact_radius_m(body, second, depth);
  if (!(apart_m > nearest && apart_m < farthest))
    fail(scene, key,
         "the tips are " + number_text(1e3 * apart_m) + " mm apart; computed for " + number_text(1e3 * nearest) +
             " to " + number_text(1e3 * farthest) +
             " mm, where their contacts are apart and on the top; give numbers instead");
  try {
    const bool alike = first.shape == second.shape && first.radius_m == second.radius_m &&
                       first.fillet_m == second.fillet_m && first.half_apex_rad == second.half_apex_rad;
    const fem::TouchFit from_a = press_beside(body, first, second, depth, apart_m),
                        from_b = alike ? from_a : press_beside(body, second, first, depth, apart_m);
    return {0.5 * (from_a.c_m_per_N + from_b.c_m_per_N), from_a.h_m_per_N2, from_b.h_m_per_N2};
  } catch (const ConfigError& error) {
    fail(scene, key, std::string(error.what()) + "; lower contact.max_depth_mm or give numbers");
  }
}

}  // namespace palpate
