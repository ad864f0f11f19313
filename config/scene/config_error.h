// The one exception of the scene compiler. Its text is meant for the person who wrote the scene: file, line, key, what
// is wrong, what is allowed and what to do.
#pragma once

#include <stdexcept>
#include <string>

namespace palpate {

class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(const std::string& text) : std::runtime_error(text) {}
};

}  // namespace palpate
