// Makes a recording of what a killed run left behind: NAME.part, and the last seconds that the controller wrote itself
// after its host had died (NAME.crash.plr), as far as they go together.
#pragma once

#include <cstdint>
#include <string>

namespace palpate {

struct Recovered {
  std::uint64_t records = 0;     // in the recovered recording
  std::uint64_t from_crash = 0;  // of these, from the controller's own file
  std::uint64_t lost = 0;        // gaps
  std::string path, crash_path;  // crash_path: empty when there was none that fits
  std::string damage;            // where the .part file ends, as the reader says it
};

// `output` empty: the name without .part. The .part file is removed once the recovered one is complete. Throws
// RecordingError when a run still writes it, nothing in it can be read, or `output` exists.
Recovered recover_recording(const std::string& part, const std::string& output);

// Where the controller of a run recorded as `recording` writes when its host dies.
std::string crash_path(const std::string& recording);

}  // namespace palpate
