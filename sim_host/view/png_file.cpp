#include "sim_host/view/png_file.h"

#include <png.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace palpate {

void write_png(const std::string& path, int width, int height, std::span<const std::uint8_t> rgb) {
  const std::size_t expected = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3;
  if (width <= 0 || height <= 0 || rgb.size() != expected) throw std::runtime_error(path + ": wrong picture size");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  errno = 0;
  if (png_image_write_to_file(&image, path.c_str(), 0, rgb.data(), 0, nullptr) == 0) {
    throw std::runtime_error(path + ": cannot write: " + (errno != 0 ? std::strerror(errno) : image.message));
  }
}

}  // namespace palpate
