// A recorded run as a moving picture: the deformed body, tool and forces from one place, to one scale.
#pragma once

#include <functional>
#include <string>

#include "sim_host/record/recording_reader.h"
#include "sim_host/view/view_scales.h"

namespace palpate {

struct MovieOptions {
  double from_s = -1, to_s = -1;  // of the run; < 0: from shortly before the first touch to shortly after the last
  double speed = 1;               // 1: as it was; 0.5: half as fast
  int per_second = 15;            // frames shown in a second
  int width = 640, height = 480;
  SurfaceColour colour = SurfaceColour::kDisplacement;
};

inline constexpr int kMostFrames = 3000;

struct MovieMade {
  int frames = 0;
  double from_s = 0, to_s = 0;
};

// Writes an animated PNG. `progress` gets the part that is done. Throws std::runtime_error (RecordingError for what is
// wrong with the recording) with the reason.
MovieMade save_movie(const std::string& path, std::span<const std::byte> recording, const Model& model,
                     const MovieOptions& options, const std::function<void(double)>& progress);

}  // namespace palpate
