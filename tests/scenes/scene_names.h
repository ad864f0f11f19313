// The shipped scenes, as the build lists them.
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace palpate::test {

inline std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  std::istringstream list(PALPATE_SCENES);
  for (std::string name; std::getline(list, name, '|');) names.push_back(name);
  return names;
}

}  // namespace palpate::test
