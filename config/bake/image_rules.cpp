#include "config/bake/image_rules.h"

#include <cstring>

#include "config/bake/opened_image.h"
#include "config/scene/config_error.h"
#include "config/tool/piece_card.h"
#include "rt_core/tool/shapes.h"

namespace palpate {

namespace {

static_assert(kMaxMutualAnchors == 17, "the words below name it");

// Where the scene says what the loader refuses. `key`: %d is the element; nullptr: no key stands behind it.
struct SceneKey {
  const char* field;
  const char* key;
  const char* hand_key;  // the same of a hand, whose pieces no key describes one by one
  const char* what;
};
constexpr SceneKey kKeys[] = {
    {"piece.tip_points", "tool.piece[%d].points", "hand",
     "a tip has one point: allowed 0 or 1 with laws of whole tips, contact.law = \"tool\" and \"table\"; set points = "
     "1 (cylinder, capsule: touches an end; cone: plus_z). A hand's parts touch with several: use \"duffing\", "
     "\"cubic\" or \"hertz\""},
    {"piece.hull_faces", "tool.piece[%d].vertices_mm", "hand",
     "corners of one plane, without a volume, which contact.backend = \"nodal\" needs of a hull; add a corner beside "
     "that plane, or take a box, whose sides may be thin"},
    {"anchor.mutual", "skeleton.anchors_max", "skeleton.anchors_max",
     "more anchors than coupling.law = \"mutual_paper\" has room for beside the beams between contacts: at most 17"},
    {"friction_law", "friction.law", "friction.law", "is not for this method of contact"},
};

std::string element_of(const char* key, std::int64_t index) {
  std::string text = key;
  const auto at = text.find("%d");
  return at == std::string::npos ? text : text.replace(at, 2, std::to_string(index));
}

}  // namespace

Model model_of(const ImageContents& image) {
  Model model;
  model.params = image.params;
  model.sizes = sizes_of(image);
#define PALPATE_FIELD(type, name, count, frame, meaning) model.name = image.name;
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return model;
}

ImageContents contents_of(const Model& model) {
  ImageContents image;
  image.name = model.name;
  image.params = model.params;
#define PALPATE_FIELD(type, name, count, frame, meaning) image.name.assign(model.name.begin(), model.name.end());
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return image;
}

void refuse(const SceneDesc& scene, const ImageResult& result) {
  if (result.error == ImageError::kNone) return;
  const bool hand = scene.articulation == Articulation::kHand;
  for (const SceneKey& known : kKeys)
    if (std::strcmp(known.field, result.field) == 0)
      throw ConfigError(scene.source.where(element_of(hand ? known.hand_key : known.key, result.index)) + ": " +
                        known.what);
  throw ConfigError(scene.source.file + ": the image made of this scene would be refused: " + result.field +
                    (result.index < 0 ? "" : "[" + std::to_string(result.index) + "]") + ": " + describe(result.error) +
                    "; change what the scene says of it, see docs/image_format.md");
}

void set_hands(const SceneDesc& scene, ImageContents& image) {
  ModelParams& p = image.params;
  p.held_part = scene.device.holds;
  const bool two_tools = p.held_part == HeldPart::kTwoTools;
  const Vec3 grip_m = two_tools ? scene.path.second.front().position_m : scene.device.grip_m;
  p.grip_x_m = grip_m.x, p.grip_y_m = grip_m.y, p.grip_z_m = grip_m.z;
  if (!two_tools) return;
  p.articulation = Articulation::kTwoTools;
  for (std::size_t i = 0; i < image.piece.size(); ++i) {
    image.piece[i].joint = -1;
    image.piece[i].group = scene.piece[i].hand - 1;
  }
}

void check_bytes(const SceneDesc& scene, std::span<const std::byte> bytes) {
  refuse(scene, OpenedImage(bytes).result());
}

}  // namespace palpate
