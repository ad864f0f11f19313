// lab_scene SCENE.toml FOLDER: what a scene tells the simulated device, for the guest, which has no parser of scenes:
// FOLDER/NAME.csv, the hand's motion, FOLDER/NAME.args, the properties of device and hand, and FOLDER/NAME.device, the
// name of its profile.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "config/bake/compile.h"
#include "sim_host/run/device_process.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("lab_scene SCENE.toml FOLDER\n", stderr), 2;
  try {
    const palpate::SceneDesc scene = palpate::load_scene(argv[1]);
    const std::filesystem::path to = std::filesystem::path(argv[2]) / std::filesystem::path(argv[1]).stem();
    std::ofstream(to.string() + ".csv") << palpate::path_csv(scene);
    std::ofstream(to.string() + ".args") << fmt::format("{}\n", fmt::join(palpate::plant_arguments(scene), " "));
    std::ofstream(to.string() + ".device") << scene.device.name << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lab_scene: %s\n", error.what());
    return 3;
  }
}
