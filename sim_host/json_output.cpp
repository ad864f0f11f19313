#include "sim_host/json_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <stdexcept>

#include "sim_host/cli_checks.h"

namespace palpate {

namespace {

// While it lives, standard output leads nowhere: printf, streams and children alike.
class Silence {
 public:
  Silence() {
    std::fflush(stdout);
    kept_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (kept_ < 0 || nowhere < 0 || ::dup2(nowhere, STDOUT_FILENO) < 0)
      throw std::runtime_error("--json: standard output cannot be put aside");
    ::close(nowhere);
  }
  ~Silence() {
    std::fflush(stdout);
    ::dup2(kept_, STDOUT_FILENO);
    ::close(kept_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int kept_ = -1;
};

}  // namespace

void add_json_flag(CLI::App& command, bool& json) {
  command.add_flag("--json", json, "tell the results as one JSON object instead of the text; keys: docs/json.md");
}

bool JsonOption::wanted() const { return option->count() > 0 && file.empty(); }

void add_json_option(CLI::App& command, JsonOption& json, const std::string& what) {
  json.option =
      command.add_option("--json", json.file,
                         "tell the results as one JSON object instead of the text; keys: docs/json.md. With a "
                         "file name: " +
                             what);
  json.option->expected(0, 1)->check(ends_in({".json"}));
}

int run_with_json(bool json, const std::string& command, const std::function<int(Json&)>& run) {
  Json object;
  object["command"] = command;
  object["exit_code"] = nullptr;  // its place
  if (!json) return run(object);
  int exit_code = 0;
  {
    const Silence silence;
    exit_code = run(object);
  }
  object["exit_code"] = exit_code;
  // Names of files need not be UTF-8, JSON has to be.
  const std::string text = object.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0)
    throw std::runtime_error("--json: standard output cannot be written");
  return exit_code;
}

}  // namespace palpate
