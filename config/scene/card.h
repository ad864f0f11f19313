// What the cards of tool pieces and of bodies (config/tool, config/body/shape) share.
#pragma once

#include <string>

namespace palpate {

// A key of the scene that a shape takes, and what it is there.
struct CardKey {
  const char* key;
  const char* meaning;
};
// Why a description is refused: the key to blame, within its table; nullptr: it is not.
struct Refusal {
  const char* key = nullptr;
  std::string what = {};
};

}  // namespace palpate
