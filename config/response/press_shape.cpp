#include "config/response/press_shape.h"

#include <algorithm>
#include <cmath>

#include "config/bake/contact_fit.h"
#include "config/body/body_card.h"
#include "config/body/supports.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

// The solver's stiffest volume; rubber and tissue at 0.5 differ by less than 1 % in force here.
constexpr double kLargestRatio = 0.495;

}  // namespace

fem::PressBody pressed_body(const SceneDesc& scene, const std::string& key) {
  fem::PressBody body;
  body.youngs_modulus_Pa = scene.material.youngs_modulus_Pa;
  body.poisson_ratio = std::min(effective_poisson_ratio(scene.material), kLargestRatio);
  body.slip_base = scene.layer.base == LayerBase::kSlip;
  const auto press = card_of(scene.body.shape).press;
  if (press == nullptr || !press(scene.body, standing_base_m(scene, "a press by finite elements"), body))
    throw ConfigError(
        scene.source.where(key) +
        ": presses are computed for a standing cylinder, a box, a sphere, or an ellipsoid with equal half axes along x "
        "and z; for other bodies give numbers instead of \"auto\", or measure presses and give their CSV");
  return body;
}

fem::RigidTool pressed_tool(const PieceDesc& piece, const Indenter& indenter, double depth_max_m) {
  fem::RigidTool tool;
  tool.radius_m = piece.radius_m;
  if (indenter.profile == TipProfile::kFlat) {
    tool.shape = fem::RigidShape::kPunch;
    tool.radius_m = indenter.radius_m;
    tool.fillet_m = kPressedPunchFillet * tool.radius_m;
  } else if (indenter.profile == TipProfile::kCone) {
    tool.shape = fem::RigidShape::kCone;
    tool.half_apex_rad = std::atan(indenter.tan_half_angle);
    tool.fillet_m = kPressedApexFillet * depth_max_m;
  }
  return tool;
}

fem::PressMeshing press_meshing(const fem::PressBody& body, const fem::RigidTool& tool, double depth_max_m,
                                int elements) {
  fem::PressMeshing meshing = fem::default_meshing(body, tool, depth_max_m, elements);
  if (tool.shape != fem::RigidShape::kCone) return meshing;
  // A cone touches only 2/pi of the depth times its slope (Sneddon 1965).
  const double contact = 0.64 * depth_max_m * std::tan(tool.half_apex_rad) + tool.fillet_m;
  meshing.fine_extent_m = std::min(1.25 * contact, 0.5 * std::min(body.outer_radius_m, body.height_m));
  return meshing;
}

}  // namespace palpate
