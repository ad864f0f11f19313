// `palpate view`: hands over to the program palpate-view beside this one.
#include <CLI/CLI.hpp>

#include "config/scene/child_program.h"
#include "sim_host/cli.h"

namespace palpate {

void add_view_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("view", "Look at a run, recorded or going on, and take part with the mouse");
  command->set_help_flag();  // --help is palpate-view's to answer
  command->prefix_command();
  command->callback([command] {
    become_program("palpate-view", command->remaining(),
                   "build it with -DPALPATE_VIEW=ON (it needs the packages libglfw3-dev, libimgui-dev and "
                   "libgl-dev)");
  });
}

}  // namespace palpate
