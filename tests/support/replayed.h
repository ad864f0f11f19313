// Whether a recording replays to the bit.
#pragma once

#include <string>

#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/replay.h"

namespace palpate::test {

// "identical", or what differs.
inline std::string replayed(const std::string& path) {
  const MappedFile file(path);
  RecordingReader recording(file.bytes());
  const RecordedScene scene(recording, "");
  const ReplayResult result = replay(recording, scene.model());
  return result.identical() ? "identical" : result.stage + " " + result.field + " " + result.damage;
}

}  // namespace palpate::test
