// Where a scene puts its body: body.position_mm and body.rotation_deg, from the shape's or file's own coordinates to
// the world's. A body that stays where it is keeps its bits.
#pragma once

#include <vector>

#include "config/scene/scene.h"

namespace palpate {

bool is_moved(const BodyDesc& body);
Pose body_pose(const BodyDesc& body);
// To the world, and back from it.
void place(const BodyDesc& body, std::vector<Vec3>& point_m);
void take_back(const BodyDesc& body, std::vector<Vec3>& point_m);

}  // namespace palpate
