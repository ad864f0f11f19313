#include "config/response/press_bake.h"

#include <algorithm>
#include <cmath>

#include "config/config_error.h"
#include "config/contact_fit.h"
#include "config/fem/series_fit.h"
#include "config/schema.h"
#include "rt_core/response/tip_law.h"

namespace palpate {

namespace {

// Edge of a flat punch and apex of a cone, rounded for the solver: small against the contact, large against the mesh.
constexpr double kPunchFillet = 0.1;  // of the radius
constexpr double kApexFillet = 0.05;  // of the deepest press
// Elements under the tool, in the order they are tried: the large-strain solver now and then finds no equilibrium on
// one mesh that it finds on another.
constexpr int kElements[] = {12, 10, 16};
// The solver's stiffest volume; rubber and tissue at 0.5 differ by less than 1 % in force here.
constexpr double kLargestRatio = 0.495;

[[noreturn]] void fail(const SceneDesc& scene, const std::string& key, const std::string& what) {
  throw ConfigError(scene.source.where(key) + ": " + what);
}

fem::PressBody press_body(const SceneDesc& scene, const std::string& key) {
  const BodyDesc& b = scene.body;
  fem::PressBody body;
  body.youngs_modulus_Pa = scene.material.youngs_modulus_Pa;
  body.poisson_ratio = std::min(effective_poisson_ratio(scene.material), kLargestRatio);
  body.slip_base = scene.layer.thickness_m > 0 && scene.layer.base == LayerBase::kSlip;
  const auto round = [&](double across, double along) {
    body.kind = fem::PressBody::Kind::kEllipsoid;
    body.outer_radius_m = across;
    body.height_m = along;
    body.fixed_below_m = scene.fixed.base_height_m - along;
  };
  if (b.shape == BodyShape::kCylinder && b.axis == BodyAxis::kY) {
    body.outer_radius_m = b.radius_m;
    body.height_m = b.height_m;
  } else if (b.shape == BodyShape::kBox) {
    body.outer_radius_m = 0.5 * std::min(b.size_m.x, b.size_m.z);
    body.height_m = b.size_m.y;
  } else if (b.shape == BodyShape::kSphere) {
    round(b.radius_m, b.radius_m);
  } else if (b.shape == BodyShape::kEllipsoid && b.half_axes_m.x == b.half_axes_m.z) {
    round(b.half_axes_m.x, b.half_axes_m.y);
  } else {
    fail(scene, key,
         "can be computed for bodies of revolution pressed at their top only: a standing cylinder, a box, a sphere, an "
         "ellipsoid with equal half axes along x and z; give numbers instead");
  }
  return body;
}

fem::RigidTool press_tool(const PieceDesc& piece, const Indenter& indenter, double depth_max_m) {
  fem::RigidTool tool;
  switch (indenter.profile) {
    case TipProfile::kFlat:
      tool.shape = fem::RigidShape::kPunch;
      tool.radius_m = indenter.radius_m;
      tool.fillet_m = kPunchFillet * indenter.radius_m;
      break;
    case TipProfile::kCone:
      tool.shape = fem::RigidShape::kCone;
      tool.half_apex_rad = std::atan(indenter.tan_half_angle);
      tool.fillet_m = kApexFillet * depth_max_m;
      break;
    default:
      tool.radius_m = piece.radius_m;
  }
  return tool;
}

}  // namespace

FarFieldFit fit_far_field(const SceneDesc& scene, std::size_t piece, const TipDesc& tip) {
  const std::string key = "contact.series.c0_mm_per_N";
  std::vector<FactorKnot> factor;
  const TipLaw law = make_tip_law(tip, factor);
  const LocalLaw local{&law, law.first_factor < 0 ? nullptr : factor.data()};
  const auto depth_of =
      fem::inverse_of([local](double depth) { return local_at(local, depth).force_N; }, tip.depth_max_m);
  const fem::PressBody body = press_body(scene, key);
  const fem::RigidTool tool = press_tool(scene.piece[piece], tip.indenter, tip.depth_max_m);
  std::string why;
  for (const int elements : kElements) {
    try {
      const fem::SeriesCoefficients c = fem::bake_series(body, tool, depth_of, tip.depth_max_m, elements).coefficients;
      return {c.c0_m_per_N, c.c1_m_per_N2};
    } catch (const ConfigError& error) {
      why = error.what();
    }
  }
  fail(scene, key, why + "; lower contact.max_depth_mm or give numbers");
}

}  // namespace palpate
