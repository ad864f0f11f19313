// The table of every key a scene file may hold: one source for the reader's checks and for the documentation.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "config/scene/scene.h"

namespace palpate {

enum class KeyKind {
  kNumber,
  kNumberOrAuto,
  kInteger,
  kBool,
  kBoolOrAuto,
  kText,
  kChoice,
  kVec3,
  kPairs,
  kPoints,
  kFingers,
  kNumberOrFingers,
  kIntegers
};

struct KeySpec {
  const char* key;  // with its unit as suffix
  KeyKind kind;
  double lowest, highest;  // in the key's own unit; of each component of vectors and lists
  double scale;            // key's unit to SI
  bool required;
  std::span<const char* const> choices;  // words in the order of the enumeration (kChoice), otherwise empty
  const char* meaning;
  void* (*field)(void* table);  // address of the member; unused for kChoice
  void (*set_choice)(void* table, std::int32_t value);
  std::int32_t (*get_choice)(const void* table);
};

enum class TableCount {
  kOne,
  kList,       // [[tool.piece]]
  kOneOrList,  // [body.fixed] or [[body.fixed]]
};

struct TableSpec {
  const char* name;  // "" is the top level
  TableCount count;
  const char* meaning;
  std::span<const KeySpec> keys;
  void* (*open)(SceneDesc& scene);  // the table's struct; a new element for arrays
};

std::span<const TableSpec> scene_schema();

// Number in the key's unit, shortest text that reads back the same.
std::string number_text(double value);
// "(1.2, 0, -35.01) mm", rounded to a hundredth.
std::string position_text(Vec3 p_m);
// "0.001 to 1000 mm", "one of a, b, c", ...
std::string allowed_text(const KeySpec& key);

}  // namespace palpate
