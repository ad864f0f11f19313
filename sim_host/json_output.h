// --json: a command tells its results as one JSON object on standard output in place of its text. docs/json.md has the
// keys; names end in their unit, numbers are in that unit, what is not finite is null.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace palpate {

using Json = nlohmann::ordered_json;

void add_json_flag(CLI::App& command, bool& json);
// Of commands whose --json FILE writes something of its own (`what`): without FILE it is the flag above.
struct JsonOption {
  CLI::Option* option = nullptr;
  std::string file;
  bool wanted() const;  // on standard output
};
void add_json_option(CLI::App& command, JsonOption& json, const std::string& what);

// Runs a command and returns its exit code. With `json`, nothing that it and the programs it starts print on standard
// output gets there: the object does that it has filled in, which begins with the command's name and its exit code.
// When it throws, nothing is printed. Files, standard error and exit codes are the same either way.
int run_with_json(bool json, const std::string& command, const std::function<int(Json&)>& run);

}  // namespace palpate
