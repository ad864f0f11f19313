// `palpate`: everything a person types. Registers the commands and turns errors into one line and an exit code.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "sim_host/build_id.h"
#include "sim_host/cli.h"

int main(int argc, char** argv) {
  CLI::App app{"Feel soft objects: a haptic controller that is never late."};
  app.set_version_flag("--version", palpate::kBuildId);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  palpate bake config/scenes/ellipsoid_mallet.toml -o mallet.pal\n"
      "  palpate run mallet.pal --device loopback --duration 10 --record run.plr\n"
      "  palpate replay run.plr\n"
      "`palpate COMMAND --help` shows the options of one command.");
  int exit_code = palpate::kExitOk;
  palpate::add_bake_command(app, exit_code);
  palpate::add_press_command(app, exit_code);
  palpate::add_run_command(app, exit_code);
  palpate::add_replay_command(app, exit_code);
  palpate::add_latency_command(app, exit_code);
  palpate::add_picture_command(app, exit_code);
  palpate::add_grasp_command(app, exit_code);
  palpate::add_doctor_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? palpate::kExitOk : palpate::kExitUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate: %s\n", error.what());
    return palpate::kExitUsage;
  }
  return exit_code;
}
