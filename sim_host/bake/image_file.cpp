#include "sim_host/bake/image_file.h"

#include <fmt/format.h>

#include <stdexcept>

namespace palpate {

ImageFile::ImageFile(const std::string& path) {
  std::string error;
  file_ = PrivateFile::read(path, error);
  if (!file_) throw std::runtime_error(error);
  const ImageResult result = open_image(file_.bytes(), model_);
  if (result.error == ImageError::kNone) return;
  const std::string at = result.index >= 0 ? fmt::format("[{}]", result.index) : "";
  const std::string range =
      result.error == ImageError::kParamRange ? fmt::format(" ({:g} to {:g})", result.lowest, result.highest) : "";
  throw std::runtime_error(
      fmt::format("{}: {}{}: {}{}; bake the scene again", path, result.field, at, describe(result.error), range));
}

}  // namespace palpate
