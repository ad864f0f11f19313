// `palpate mesh`: hands over to the program palpate-mesh beside this one.
#include <CLI/CLI.hpp>

#include "config/scene/child_program.h"
#include "sim_host/cli.h"

namespace palpate {

void add_mesh_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("mesh", "Repair and remesh a body's surface (STL, OBJ, PLY)");
  command->set_help_flag();  // --help is palpate-mesh's to answer
  command->prefix_command();
  command->callback([command] {
    become_program("palpate-mesh", command->remaining(),
                   "build it with -DPALPATE_MESH=ON (it needs the package libcgal-dev)");
  });
}

}  // namespace palpate
