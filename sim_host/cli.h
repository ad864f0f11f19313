// The commands of the `palpate` program. Each file cmd_NAME.cpp adds one subcommand with its options, help and
// examples; its callback stores the process exit code.
#pragma once

#include <string>

#include "sim_host/exit_codes.h"

namespace CLI {
class App;
}

namespace palpate {

struct JointOptions;

// `what`, beginning with the file it is about.
inline std::string about_file(const std::string& file, const std::string& what) {
  return what.starts_with(file) ? what : file + ": " + what;
}

// Each registers its subcommand; when the user picks it, the callback sets `exit_code`. Errors may be thrown as
// std::exception: main prints what() after "palpate: " and exits with kExitUsage.
void add_bake_command(CLI::App& app, int& exit_code);
void add_explain_command(CLI::App& app, int& exit_code);
void add_certify_command(CLI::App& app, int& exit_code);
void add_mesh_command(CLI::App& app, int& exit_code);
void add_press_command(CLI::App& app, int& exit_code);
void add_run_command(CLI::App& app, int& exit_code);
void add_set_command(CLI::App& app, int& exit_code);
void add_switch_command(CLI::App& app, int& exit_code);
void add_replay_command(CLI::App& app, int& exit_code);
void add_recover_command(CLI::App& app, int& exit_code);
void add_latency_command(CLI::App& app, int& exit_code);
void add_view_command(CLI::App& app, int& exit_code);
void add_picture_command(CLI::App& app, int& exit_code);
void add_movie_command(CLI::App& app, int& exit_code);
void add_grasp_command(CLI::App& app, int& exit_code);
void add_feel_command(CLI::App& app, int& exit_code);
void add_compare_command(CLI::App& app, int& exit_code);
void add_fit_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_doctor_command(CLI::App& app, int& exit_code);
void add_device_test_command(CLI::App& app, int& exit_code);

// --close, --joint and --joints, for commands that drive articulated tools. `options` must outlive the parsing.
void add_joint_options(CLI::App& command, JointOptions& options);

}  // namespace palpate
