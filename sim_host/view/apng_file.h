// A moving picture as an animated PNG (APNG, W3C PNG third edition 2025, section 11.3.4): every browser and README
// shows it, and whatever knows only PNG shows its first frame.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim_host/record/part_file.h"

namespace palpate {

class ApngFile {
 public:
  // `frames`, known beforehand, are shown `per_second` (1..100) and then again from the first. Appears under its name
  // when finish() is called. Throws RecordingError naming the file when the file system refuses.
  ApngFile(const std::string& path, int width, int height, int frames, int per_second);
  // 3 bytes per pixel, rows from the top. Only what differs from the frame before is written. Throws std::runtime_error
  // for another size, or for more frames than were announced.
  void add(std::span<const std::uint8_t> rgb);
  // Throws std::runtime_error when frames are missing.
  void finish();

 private:
  struct Part {
    int x, y, width, height;
  };
  void chunk(const char (&type)[5], std::span<const std::uint8_t> data);
  Part changed(std::span<const std::uint8_t> rgb) const;

  PartFile file_;
  int width_, height_, frames_, per_second_, added_ = 0;
  std::uint32_t sequence_ = 0;  // of fcTL and fdAT chunks together
  std::vector<std::uint8_t> last_;
};

}  // namespace palpate
