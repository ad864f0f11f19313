// A scene image copied from its file, then checked completely.
#pragma once

#include <string>

#include "hal/system/private_file.h"
#include "rt_core/image.h"

namespace palpate {

// Throws std::runtime_error naming file, field and reason when the file is missing or is no valid image.
class ImageFile {
 public:
  explicit ImageFile(const std::string& path);
  const Model& model() const { return model_; }
  std::span<const std::byte> bytes() const { return file_.bytes(); }

 private:
  PrivateFile file_;
  Model model_;
};

}  // namespace palpate
