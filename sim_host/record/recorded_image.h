// The scene image inside a recording: in pieces (zlib), so that a recording can be replayed and drawn anywhere.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rt_core/image.h"
#include "sim_host/bake/image_file.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/recording_writer.h"

namespace palpate {

// Stored: an image is floats, of which zlib's fastest level takes 12 to 14 %, for 130 instructions a byte before a run
// can arm. 10.6 MB of half_shell took 0.22 s, stored 4 ms (2026-11-26).
std::vector<PackedPiece> pack_image(std::span<const std::byte> image);

// The scene a recording was made with, checked completely: from `image` when that is not empty (whatever it is), else
// from the file the recording names when it is still the same, else from inside the recording.
class RecordedScene {
 public:
  // Throws std::runtime_error naming what is missing or wrong.
  RecordedScene(const RecordingReader& recording, const std::string& image);
  const Model& model() const { return model_; }
  // Where it came from, for the user.
  const std::string& source() const { return source_; }

 private:
  struct alignas(kImageAlignment) Block {
    std::byte bytes[kImageAlignment];
  };

  void unpack(const RecordingReader& recording);

  std::unique_ptr<ImageFile> file_;
  std::vector<Block> inside_;
  Model model_;
  std::string source_;
};

}  // namespace palpate
