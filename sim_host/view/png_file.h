// Writes an image as a PNG file through libpng.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace palpate {

// `rgb`: 3 bytes per pixel, rows from the top. Throws std::runtime_error naming the file when it cannot be written.
void write_png(const std::string& path, int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace palpate
