// `palpate`: everything a person types. Registers the commands and turns errors into one line and an exit code.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "config/scene/child_program.h"
#include "sim_host/build_id.h"
#include "sim_host/cli.h"

namespace {

// Empty, or what to say of a first word that is no command.
std::string unknown_command(const CLI::App& app, const std::string& word) {
  if (word.starts_with("-")) return "";
  std::string text = "no command '" + word + "'; the commands are";
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == word) return "";
    text += " " + command->get_name();
  }
  return text + "; `palpate --help` says what they do";
}

// Where the shipped scenes are: in the folder it was fetched into, or where it is installed.
std::string scene_folder() {
  std::error_code error;
  const std::filesystem::path fetched = "config/scenes";
  const std::filesystem::path program = palpate::sibling_program("palpate");
  const std::filesystem::path installed = program.parent_path().parent_path() / "share/palpate" / fetched;
  return (!std::filesystem::exists(fetched, error) && std::filesystem::exists(installed, error) ? installed : fetched)
      .string();
}

// What `palpate` alone says.
void welcome() {
  const std::string scenes = scene_folder();
  fmt::print(
      "Palpate: feel soft objects. Three things to begin with:\n"
      "  palpate run {0}/ellipsoid_mallet.toml     a simulated hand presses a soft ellipsoid\n"
      "  palpate view {0}/ellipsoid_mallet.toml    your mouse is the device\n"
      "  palpate press {0}/ring.toml --plot f.svg  force against time, no device at all\n"
      "`palpate --help` lists every command, `palpate COMMAND --help` what one can do.\n",
      scenes);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on files is an error that is told, not the end of a run
  // Lines in their order where standard output and standard error go to one file.
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  CLI::App app{"Feel soft objects: a haptic controller that is never late."};
  app.set_version_flag("--version", palpate::kBuildId);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  palpate bake config/scenes/ellipsoid_mallet.toml -o mallet.pal\n"
      "  palpate run config/scenes/ellipsoid_mallet.toml --device loopback --record run.plr\n"
      "  palpate replay run.plr\n"
      "`palpate COMMAND --help` shows the options of one command.");
  int exit_code = palpate::kExitOk;
  palpate::add_bake_command(app, exit_code);
  palpate::add_mesh_command(app, exit_code);
  palpate::add_explain_command(app, exit_code);
  palpate::add_certify_command(app, exit_code);
  palpate::add_press_command(app, exit_code);
  palpate::add_run_command(app, exit_code);
  palpate::add_set_command(app, exit_code);
  palpate::add_switch_command(app, exit_code);
  palpate::add_replay_command(app, exit_code);
  palpate::add_recover_command(app, exit_code);
  palpate::add_latency_command(app, exit_code);
  palpate::add_picture_command(app, exit_code);
  palpate::add_movie_command(app, exit_code);
  palpate::add_view_command(app, exit_code);
  palpate::add_grasp_command(app, exit_code);
  palpate::add_feel_command(app, exit_code);
  palpate::add_compare_command(app, exit_code);
  palpate::add_fit_command(app, exit_code);
  palpate::add_report_command(app, exit_code);
  palpate::add_doctor_command(app, exit_code);
  palpate::add_device_test_command(app, exit_code);
  if (argc == 1) {
    welcome();
    return palpate::kExitOk;
  }
  if (const std::string unknown = argc > 1 ? unknown_command(app, argv[1]) : ""; !unknown.empty()) {
    std::fprintf(stderr, "palpate: %s\n", unknown.c_str());
    return palpate::kExitUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? palpate::kExitOk : palpate::kExitUsage;
  } catch (const palpate::ExitError& error) {
    std::fprintf(stderr, "palpate: %s\n", error.what());
    return error.code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate: %s\n", error.what());
    return palpate::kExitUsage;
  }
  return exit_code;
}
