// Surface swept by a profile about the y axis.
#include <algorithm>

#include "config/body/body_card.h"

namespace palpate {

namespace {

constexpr CardKey kKeys[] = {{"profile_mm", "points [radius, height] from bottom to top"},
                             {"triangles", "about this many"}};

Refusal check(const BodyDesc& body) {
  const std::vector<ProfilePoint>& p = body.profile;
  const auto refuse = [](const std::string& what) { return Refusal{"profile_mm", what}; };
  if (p.size() < 2) return refuse(std::to_string(p.size()) + " points; allowed at least 2, from bottom to top");
  double widest = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const std::string point = "point " + std::to_string(i);
    if (p[i].radius_m < 0) return refuse(point + " has a negative radius; allowed 0 or more");
    if (p[i].radius_m == 0 && i > 0 && i + 1 < p.size())
      return refuse(point + " touches the axis; only the first and last point may have radius 0");
    if (i > 0 && p[i].radius_m == p[i - 1].radius_m && p[i].height_m == p[i - 1].height_m)
      return refuse(point + " repeats the one before; remove it");
    widest = std::max(widest, p[i].radius_m);
  }
  if (!(widest >= 0.5e-3)) return refuse("the largest radius is below 0.5 mm; check the unit (mm)");
  if (!(p.back().height_m > p.front().height_m))
    return refuse("runs from top to bottom; list the points from bottom to top");
  return {};
}

SurfaceMesh make(const SceneDesc& scene, std::string&, std::vector<std::string>&) {
  return make_revolution(scene.body.profile, scene.body.triangles);
}

std::vector<AnchorPoint> anchors(const BodyDesc& body) { return revolution_anchors(body.profile); }

}  // namespace

extern const BodyCard revolution_body;
const BodyCard revolution_body{
    .meaning = "surface of revolution about y", .keys = kKeys, .check = check, .make = make, .anchors = anchors};

}  // namespace palpate
