// A scene image mapped from its file, checked completely.
#pragma once

#include <string>

#include "rt_core/image.h"
#include "sim_host/record/recording.h"

namespace palpate {

// Throws std::runtime_error naming file, field and reason when the file is missing or is no valid image.
class ImageFile {
 public:
  explicit ImageFile(const std::string& path);
  const Model& model() const { return model_; }

 private:
  MappedFile file_;
  Model model_;
};

}  // namespace palpate
