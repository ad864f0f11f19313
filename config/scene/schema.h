// The table of every key a scene file may hold: one source for the reader's checks and for the documentation.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "config/scene/scene.h"

namespace palpate {

enum class KeyKind { kNumber, kNumberOrAuto, kInteger, kBool, kText, kChoice, kVec3, kPairs, kPoints, kFingers };

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

struct TableSpec {
  const char* name;  // "" is the top level; "tool.piece" and "path.point" are arrays of tables
  bool is_array;
  const char* meaning;
  std::span<const KeySpec> keys;
  void* (*open)(SceneDesc& scene);  // the table's struct; a new element for arrays
};

std::span<const TableSpec> scene_schema();

// Number in the key's unit, shortest text that reads back the same.
std::string number_text(double value);
// "0.001 to 1000 mm", "one of a, b, c", ...
std::string allowed_text(const KeySpec& key);

}  // namespace palpate
