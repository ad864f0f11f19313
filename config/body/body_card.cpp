#include "config/body/body_card.h"

#include <filesystem>

#include "config/body/body_pose.h"
#include "config/scene/schema.h"

namespace palpate {

#define PALPATE_CARD(name, word) extern const BodyCard word##_body;
PALPATE_BODY_SHAPES(PALPATE_CARD)
#undef PALPATE_CARD

const BodyCard& card_of(BodyShape shape) {
#define PALPATE_CARD(name, word) &word##_body,
  static constexpr const BodyCard* kCards[] = {PALPATE_BODY_SHAPES(PALPATE_CARD)};
#undef PALPATE_CARD
  return *kCards[static_cast<std::int32_t>(shape)];
}

std::vector<AnchorPoint> exact_anchors(const BodyDesc& body) {
  const auto anchors = card_of(body.shape).anchors;
  std::vector<AnchorPoint> found = anchors == nullptr ? std::vector<AnchorPoint>{} : anchors(body);
  if (!is_moved(body)) return found;
  const Pose pose = body_pose(body);
  for (AnchorPoint& anchor : found) {
    anchor.position_m = transform(pose, anchor.position_m);
    anchor.normal = rotate(pose.orientation, anchor.normal);
  }
  return found;
}
bool has_exact_anchors(BodyShape shape) { return card_of(shape).anchors != nullptr; }

Refusal axis_other_than(const BodyDesc& body, BodyAxis refused) {
  if (body.axis != refused) return {};
  std::string allowed;
  for (std::int32_t i = 0; i < ChoiceOf<BodyAxis>::kCount; ++i)
    if (static_cast<BodyAxis>(i) != refused)
      allowed += (allowed.empty() ? "\"" : " and \"") + std::string(ChoiceOf<BodyAxis>::kWord[i]) + "\"";
  return {"axis", "\"" + std::string(word_of(refused)) + "\" is not for this shape; allowed " + allowed};
}

Refusal wall_within(const BodyDesc& body, double room_m) {
  if (body.wall_m <= 0.9 * room_m) return {};
  return {"wall_mm", number_text(1e3 * body.wall_m) + " mm leaves no hole; allowed up to " + number_text(900 * room_m) +
                         " mm, 0.9 of the outer radius"};
}

std::string body_file(const SceneDesc& scene) {
  const std::filesystem::path file(scene.body.mesh);
  return file.is_absolute() ? scene.body.mesh : scene.source.directory + scene.body.mesh;
}

}  // namespace palpate
