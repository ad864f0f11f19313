// Scene files: refused with a ConfigError, or described completely.
#include <string>

#include "config/scene/config_error.h"
#include "config/scene/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    palpate::parse_scene(std::string(reinterpret_cast<const char*>(data), size), "fuzz.toml");
  } catch (const palpate::ConfigError&) {
  }
  return 0;
}
