// The image format's tables, from the same macros that lay it out.
#include "config/bake/image_writer.h"
#include "config/scene/schema.h"
#include "rt_core/image.h"

namespace palpate {

namespace {

// Lowest and highest value, or the words of a choice in the order of their numbers.
template <class T>
std::string range_of(auto lowest, auto highest) {
  if constexpr (Choice<T>) {
    std::string text;
    for (std::int32_t i = 0; i < ChoiceOf<T>::kCount; ++i)
      text += (i == 0 ? "" : ", ") + std::to_string(i) + " " + ChoiceOf<T>::kWord[i];
    return text;
  } else {
    return number_text(static_cast<double>(lowest)) + " to " + number_text(static_cast<double>(highest));
  }
}

}  // namespace

std::string image_markdown() {
  std::string text = "### Sizes\nAll 64-bit signed.\n\n| size | lowest | highest |\n|---|---|---|\n";
#define PALPATE_FIELD(name, lowest, highest, methods) \
  text += "| `" #name "` | " + std::to_string(lowest) + " | " + std::to_string(highest) + " |\n";
  PALPATE_MODEL_SIZES(PALPATE_FIELD)
#undef PALPATE_FIELD
  text += "\n### Parameters\n";
#define PALPATE_FIELD(type, name, unit, lowest, highest, meaning) \
  text += "| `" #name "` | " #type " | " unit " | " + range_of<type>(lowest, highest) + " | " meaning " |\n";
#define PALPATE_GROUP(title, PARAMS, methods)                                                          \
  text += "\nOf " title ":\n\n| parameter | type | unit | range | meaning |\n|---|---|---|---|---|\n"; \
  PARAMS(PALPATE_FIELD)
  PALPATE_PARAM_GROUPS(PALPATE_GROUP)
#undef PALPATE_GROUP
#undef PALPATE_FIELD
  text += "\n### Arrays\n\n| array | element | bytes each | count | frame | meaning |\n|---|---|---|---|---|---|\n";
#define PALPATE_FIELD(type, name, count, frame, meaning) \
  text += "| `" #name "` | " #type " | " + std::to_string(sizeof(type)) + " | " #count " | " frame " | " meaning " |\n";
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return text;
}

}  // namespace palpate
