// The shipped grasps, baked and played once per program.
#pragma once

#include <string>

#include "sim_host/bake/scene_model.h"
#include "sim_host/press/grasp_run.h"

namespace palpate::test {

const SceneModel& scene_named(const std::string& name);
const GraspRun& played(const std::string& name);

inline const char* const kScenes[] = {"grasp_cylinder_2", "grasp_cylinder_3", "grasp_cylinder_5",
                                      "grasp_sphere_2",   "grasp_sphere_3",   "grasp_sphere_5"};

}  // namespace palpate::test
