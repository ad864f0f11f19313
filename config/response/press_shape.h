// The scene's body and tool tip as the axisymmetric press solver sees them.
#pragma once

#include <string>

#include "config/fem/axisymmetric_press.h"
#include "config/response/layer_contact.h"
#include "config/scene/scene.h"

namespace palpate {

// Standing cylinders and boxes (as round blocks), spheres, ellipsoids of revolution about y, pressed at their top.
// Throws ConfigError naming `key` for other bodies.
fem::PressBody pressed_body(const SceneDesc& scene, const std::string& key);

// Edges and apexes that the solver cannot take sharp are rounded, relative to the radius and to the deepest press.
inline constexpr double kPressedPunchFillet = 0.1;
inline constexpr double kPressedApexFillet = 0.05;
fem::RigidTool pressed_tool(const PieceDesc& piece, const Indenter& indenter, double depth_max_m);

// An even mesh under the tool, a quarter wider than its largest contact.
fem::PressMeshing press_meshing(const fem::PressBody& body, const fem::RigidTool& tool, double depth_max_m,
                                int elements);

}  // namespace palpate
