#include "tests/articulate/grasp_scenes.h"

#include <map>
#include <memory>

namespace palpate::test {

namespace {

const std::string kFolder = std::string(PALPATE_SOURCE_DIR) + "/config/scenes/";

SceneOverlays overlays(const std::vector<std::string>& with, const std::vector<std::string>& set) {
  SceneOverlays all;
  for (const std::string& file : with) all.file.push_back(kFolder + file);
  all.setting = set;
  return all;
}

}  // namespace

// Planning a preshape takes a moment.
const SceneModel& scene_named(const std::string& name) {
  static std::map<std::string, std::unique_ptr<SceneModel>> cache;
  std::unique_ptr<SceneModel>& entry = cache[name];
  if (!entry) entry = std::make_unique<SceneModel>(kFolder + name + ".toml");
  return *entry;
}

PlayedGrasp::PlayedGrasp(const std::string& name, const std::vector<std::string>& with,
                         const std::vector<std::string>& set)
    : scene(kFolder + name + ".toml", overlays(with, set)), run(run_grasp(scene.model(), *scene.scene(), {})) {}

const GraspRun& played(const std::string& name) {
  static std::map<std::string, GraspRun> cache;
  const auto found = cache.find(name);
  if (found != cache.end()) return found->second;
  const SceneModel& scene = scene_named(name);
  return cache.emplace(name, run_grasp(scene.model(), *scene.scene(), {})).first->second;
}

}  // namespace palpate::test
