// The shipped grasps, baked and played once per program.
#pragma once

#include <string>
#include <vector>

#include "sim_host/bake/scene_model.h"
#include "sim_host/press/grasp_run.h"
#include "sim_host/press/grasp_stability.h"

namespace palpate::test {

const SceneModel& scene_named(const std::string& name);
const GraspRun& played(const std::string& name);

// One of them with overlays of config/scenes and settings laid over it.
struct PlayedGrasp {
  explicit PlayedGrasp(const std::string& name, const std::vector<std::string>& with = {},
                       const std::vector<std::string>& set = {});
  Grasp grasp() const { return grasp_of(scene.model(), *run.held); }

  SceneModel scene;
  GraspRun run;
};

inline const char* const kScenes[] = {"grasp_cylinder_2", "grasp_cylinder_3", "grasp_cylinder_5",
                                      "grasp_sphere_2",   "grasp_sphere_3",   "grasp_sphere_5"};

}  // namespace palpate::test
