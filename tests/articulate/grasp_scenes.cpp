#include "tests/articulate/grasp_scenes.h"

#include <map>
#include <memory>

namespace palpate::test {

// Planning a preshape takes a moment.
const SceneModel& scene_named(const std::string& name) {
  static std::map<std::string, std::unique_ptr<SceneModel>> cache;
  std::unique_ptr<SceneModel>& entry = cache[name];
  if (!entry)
    entry = std::make_unique<SceneModel>(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/" + name + ".toml");
  return *entry;
}

const GraspRun& played(const std::string& name) {
  static std::map<std::string, GraspRun> cache;
  const auto found = cache.find(name);
  if (found != cache.end()) return found->second;
  const SceneModel& scene = scene_named(name);
  return cache.emplace(name, run_grasp(scene.model(), *scene.scene(), {})).first->second;
}

}  // namespace palpate::test
