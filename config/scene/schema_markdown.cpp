// Text made from the schema: ranges for error messages, tables for docs/scene_format.md.
#include <charconv>
#include <cmath>

#include "config/body/body_card.h"
#include "config/scene/schema.h"
#include "config/tool/piece_card.h"
#include "rt_core/live.h"

namespace palpate {

std::string number_text(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

std::string position_text(Vec3 p_m) {
  const auto mm = [](double x_m) { return number_text(std::round(1e5 * x_m) / 100 + 0.0); };
  return "(" + mm(p_m.x) + ", " + mm(p_m.y) + ", " + mm(p_m.z) + ") mm";
}

namespace {

// Unit of a key, from its suffix; empty for pure numbers.
std::string unit_text(const std::string& key) {
  static const std::pair<const char*, const char*> kUnits[] = {
      {"_Nms_per_rad", "N m s/rad"},
      {"_Nm_per_rad", "N m/rad"},
      {"_N_per_m3", "N/m^3"},
      {"_N_per_s", "N/s"},
      {"_Ns_per_m", "N s/m"},
      {"_N_per_m", "N/m"},
      {"_kg_per_m3", "kg/m^3"},
      {"_kg_m2", "kg m^2"},
      {"_m_per_s", "m/s"},
      {"_rad_per_s", "rad/s"},
      {"_mm2", "mm^2"},
      {"_mm", "mm"},
      {"_ms", "ms"},
      {"_deg", "degrees"},
      {"_rad", "rad"},
      {"_Nm", "N m"},
      {"_N", "N"},
      {"_Pa", "Pa"},
      {"_kg", "kg"},
      {"_s", "s"},
      {"_ticks", "ticks"},
  };
  for (const auto& [suffix, unit] : kUnits)
    if (key.ends_with(suffix)) return unit;
  return "";
}

std::string choices_text(std::span<const char* const> choices) {
  std::string text = "one of ";
  for (const char* word : choices) text += std::string(word == choices.front() ? "" : ", ") + word;
  return text;
}

std::string range_text(const KeySpec& key) {
  const std::string unit = unit_text(key.key);
  return number_text(key.lowest) + " to " + number_text(key.highest) + (unit.empty() ? "" : " " + unit);
}

// A default as it would be written in a scene; rounded to 12 digits, because 40 mm is stored as 0.04 m.
std::string rounded_text(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 12).ptr;
  return std::string(text, end);
}

std::string vector_text(const Vec3& v, double scale) {
  if (is_auto(v.x)) return "-";
  return "[" + rounded_text(v.x / scale) + ", " + rounded_text(v.y / scale) + ", " + rounded_text(v.z / scale) + "]";
}

std::string default_text(const KeySpec& key, void* table) {
  if (key.required) return "required";
  switch (key.kind) {
    case KeyKind::kNumber: {
      const double value = *static_cast<double*>(key.field(table));
      return is_auto(value) ? "-" : rounded_text(value / key.scale);
    }
    case KeyKind::kNumberOrAuto: {
      const double value = *static_cast<double*>(key.field(table));
      return is_auto(value) ? "\"auto\"" : rounded_text(value / key.scale);
    }
    case KeyKind::kNumberOrFingers:
      return rounded_text(static_cast<FingerNumbers*>(key.field(table))->front() / key.scale);
    case KeyKind::kInteger:
      return std::to_string(*static_cast<std::int32_t*>(key.field(table)));
    case KeyKind::kBool:
      return *static_cast<bool*>(key.field(table)) ? "true" : "false";
    case KeyKind::kBoolOrAuto: {
      const auto value = *static_cast<std::optional<bool>*>(key.field(table));
      return !value ? "\"auto\"" : *value ? "true" : "false";
    }
    case KeyKind::kText: {
      const std::string& value = *static_cast<std::string*>(key.field(table));
      return value.empty() ? "-" : "\"" + value + "\"";
    }
    case KeyKind::kChoice:
      return "\"" + std::string(key.choices[static_cast<std::size_t>(key.get_choice(table))]) + "\"";
    case KeyKind::kVec3:
      return vector_text(*static_cast<Vec3*>(key.field(table)), key.scale);
    case KeyKind::kPairs:
    case KeyKind::kPoints:
    case KeyKind::kFingers:
    case KeyKind::kIntegers:
      return "-";
  }
  return "-";
}

}  // namespace

std::string allowed_text(const KeySpec& key) {
  switch (key.kind) {
    case KeyKind::kNumber:
      return range_text(key);
    case KeyKind::kNumberOrAuto:
      return "\"auto\" or " + range_text(key);
    case KeyKind::kInteger:
      return "whole number, " + range_text(key);
    case KeyKind::kBool:
      return "true or false";
    case KeyKind::kBoolOrAuto:
      return "\"auto\", true or false";
    case KeyKind::kText:
      return "text of 1 to " + number_text(key.highest) + " characters";
    case KeyKind::kChoice:
      return choices_text(key.choices);
    case KeyKind::kVec3:
      return "[x, y, z], each " + range_text(key);
    case KeyKind::kPairs:
      return "list of [radius, height], each " + range_text(key);
    case KeyKind::kFingers:
      return "list of 1 or " + std::to_string(kMaxFingers) + " numbers, each " + range_text(key);
    case KeyKind::kNumberOrFingers:
      return range_text(key) + ", or " + std::to_string(kMaxFingers) + " of them as a list";
    case KeyKind::kPoints:
      return "list of [x, y, z], each " + range_text(key);
    case KeyKind::kIntegers:
      return "list of whole numbers, each " + range_text(key);
  }
  return "";
}

namespace {

std::string keys_text(std::span<const CardKey> keys) {
  std::string text;
  for (const CardKey& key : keys) text += (text.empty() ? "`" : "; `") + std::string(key.key) + "` " + key.meaning;
  return text.empty() ? "-" : text;
}

// What each shape takes, from the cards.
std::string body_shapes_markdown() {
  std::string text = "Shapes of bodies:\n\n| shape | is | keys | anchors |\n|---|---|---|---|\n";
  for (std::int32_t i = 0; i < ChoiceOf<BodyShape>::kCount; ++i) {
    const BodyCard& card = card_of(static_cast<BodyShape>(i));
    text += "| `" + std::string(ChoiceOf<BodyShape>::kWord[i]) + "` | " + card.meaning + " | " + keys_text(card.keys) +
            " | " + (card.anchors != nullptr ? "exact" : "from the mesh") + " |\n";
  }
  return text;
}

std::string piece_shapes_markdown() {
  std::string text =
      "Shapes of pieces:\n\n| shape | sizes, all needed | margin_mm | ends | tip law |\n|---|---|---|---|---|\n";
  for (std::int32_t i = 0; i < ChoiceOf<PieceShape>::kCount; ++i) {
    const PieceCard& card = card_of(static_cast<PieceShape>(i));
    text += "| `" + std::string(ChoiceOf<PieceShape>::kWord[i]) + "` | " + keys_text(card.sizes) + " | " +
            (card.margin == nullptr ? "-" : card.margin) + " | " + (card.has_ends ? "yes" : "-") + " | " +
            (card.tip == nullptr ? "-" : "yes") + " |\n";
  }
  return text;
}

// Of a key that may change while a run goes on (rt_core/live.h).
std::string live_text(const std::string& path) {
#define PALPATE_FIELD(name, lowest, highest, key, what) \
  if (path == key) return ". **Live**: [`" #name "`](live_settings.md)";
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return "";
}

}  // namespace

std::string schema_markdown() {
  std::string text;
  for (const TableSpec& table : scene_schema()) {
    SceneDesc defaults;
    void* fields = table.open(defaults);
    const std::string name = table.name;
    text += name.empty()                       ? "### Top level\n"
            : table.count == TableCount::kList ? "### `[[" + name + "]]`\n"
                                               : "### `[" + name + "]`\n";
    text += std::string(table.meaning) + "\n\n| key | default | allowed | meaning |\n|---|---|---|---|\n";
    for (const KeySpec& key : table.keys)
      text += "| `" + std::string(key.key) + "` | " + default_text(key, fields) + " | " + allowed_text(key) + " | " +
              key.meaning + live_text(name + "." + key.key) + " |\n";
    if (name == "body") text += "\n" + body_shapes_markdown();
    if (name == "tool.piece") text += "\n" + piece_shapes_markdown();
    text += "\n";
  }
  text.pop_back();  // no empty line at the end
  return text;
}

}  // namespace palpate
