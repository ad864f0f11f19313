// `palpate mesh`: hands over to the program palpate-mesh beside this one.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>

#include "config/scene/child_program.h"
#include "sim_host/cli.h"

namespace palpate {

namespace {

[[noreturn]] void become_palpate_mesh(const std::vector<std::string>& arguments) {
  const std::string program = sibling_program("palpate-mesh");
  std::vector<std::string> all{program};
  all.insert(all.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& a : all) argv.push_back(a.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  throw std::runtime_error(program + ": " + std::strerror(errno) +
                           "; build it with -DPALPATE_MESH=ON (it needs the package libcgal-dev)");
}

}  // namespace

void add_mesh_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("mesh", "Repair and remesh a body's surface (STL, OBJ, PLY)");
  command->set_help_flag();  // --help is palpate-mesh's to answer
  command->prefix_command();
  command->callback([command] { become_palpate_mesh(command->remaining()); });
}

}  // namespace palpate
