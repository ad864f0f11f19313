// Programs the baker runs beside itself, and the folder they work in.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

// Made empty in the folder for temporary files (TMPDIR), gone with this object.
class TemporaryFolder {
 public:
  // Throws ConfigError when it cannot be made.
  explicit TemporaryFolder(const std::string& prefix);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline constexpr int kProgramMissing = 127;
// Runs a program, by path or by name along PATH, with nothing to read and both outputs in the file `log`; its exit
// status, kProgramMissing when there is none, 1 when a signal ended it.
int run_program(const std::vector<std::string>& arguments, const std::string& log);
// The end of a log, for a message.
std::string last_lines(const std::string& path);

// Becomes the program of that name beside the one that runs now. Throws ConfigError ending in `remedy` when it cannot.
[[noreturn]] void become_program(const std::string& name, const std::vector<std::string>& arguments,
                                 const std::string& remedy);

// Path of a program installed beside the one that runs now.
std::string sibling_program(const std::string& name);
// One of our own programs: beside the one that runs, in ../bin of it, or else a name to be found along PATH.
std::string own_program(const std::string& name);

}  // namespace palpate
