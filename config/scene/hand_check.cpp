#include "config/scene/hand_check.h"

#include <algorithm>
#include <string>

#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

[[noreturn]] void fail(const SceneDesc& scene, const std::string& key, const std::string& what) {
  throw ConfigError(scene.source.where(key) + ": " + what);
}

std::string at(const char* list, std::size_t i, const char* key) {
  return std::string(list) + "[" + std::to_string(i) + "]." + key;
}

void check_two_tools(const SceneDesc& scene) {
  if (scene.contact.backend == Backend::kNodal)
    fail(scene, "device.holds",
         "\"two_tools\" goes with contact.backend = \"elastic\" or \"response\": the problem of \"nodal\" has one "
         "coupling for all its nodes");
  for (const std::int32_t hand : {1, 2}) {
    const auto holds = [hand](const PieceDesc& piece) { return piece.hand == hand && piece.points > 0; };
    if (std::ranges::none_of(scene.piece, holds))
      fail(scene, "tool.piece",
           "hand " + std::to_string(hand) +
               " holds no piece with points; give one of them hand = " + std::to_string(hand));
  }
  if (scene.path.second.empty())
    fail(scene, "path.second", "missing; device.holds = \"two_tools\" needs to know where the second tool begins");
  if (norm(scene.path.second.front().rotation_rad) > 0)
    fail(scene, "path.second[0].rotation_deg",
         "the second tool begins as its pieces are described; turn the pieces, or let a later point turn it");
}

void check_one_tool(const SceneDesc& scene) {
  for (std::size_t i = 0; i < scene.piece.size(); ++i)
    if (scene.source.has(at("tool.piece", i, "hand")))
      fail(scene, at("tool.piece", i, "hand"), "has no effect without device.holds = \"two_tools\"; remove it");
  if (!scene.path.second.empty() && !scene.source.is_overruled("path.second"))
    fail(scene, "path.second", "has no effect without device.holds = \"two_tools\"; remove it");
}

void check_path(const SceneDesc& scene, const char* list, const std::vector<PathPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double time = points[i].time_s;
    if (i == 0 && time != 0) fail(scene, at(list, i, "time_s"), "the first point must be at time 0");
    if (i > 0 && !(time > points[i - 1].time_s))
      fail(scene, at(list, i, "time_s"),
           number_text(time) + " is not later than the point before; times must increase");
    if (scene.articulation == Articulation::kRigid && !points[i].closing.empty())
      fail(scene, at(list, i, "closing"), "has no effect with a rigid tool; remove it");
  }
}

}  // namespace

void check_hands(const SceneDesc& scene) {
  const DeviceDesc& d = scene.device;
  if (!(d.silence_hold_s <= d.silence_passive_s && d.silence_passive_s < d.silence_fault_s))
    fail(scene, "device.silence_fault_ms", "must be above silence_passive_ms, and that not below silence_hold_ms");
  const bool two_tools = d.holds == HeldPart::kTwoTools;
  if (d.holds != HeldPart::kTool && scene.articulation != Articulation::kRigid)
    fail(scene, "device.holds",
         two_tools ? "two tools are rigid ones; take tools without joints"
                   : "a held body goes with a rigid tool only; leave it out or take a tool without joints");
  if (d.holds != HeldPart::kTool && !two_tools && d.smooth_encoder.value_or(false))
    fail(scene, "device.smooth_encoder",
         "works on the handle's own steps, which are not those of the tool as seen from a held body; remove it");
  two_tools ? check_two_tools(scene) : check_one_tool(scene);
}

void check_paths(const SceneDesc& scene) {
  check_path(scene, "path.point", scene.path.point);
  check_path(scene, "path.second", scene.path.second);
}

}  // namespace palpate
