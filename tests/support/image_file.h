// A baked scene read from a file, for tests and benchmarks: every page is touched while loading, so that the first tick
// meets no page fault.
#pragma once

#include <cstddef>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "rt_core/image.h"

namespace palpate::test {

class ImageFile {
 public:
  // Throws std::runtime_error naming the file and what is wrong with it.
  explicit ImageFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) throw std::runtime_error(path + ": cannot open");
    const auto size = static_cast<std::size_t>(file.tellg());
    blocks_.resize((size + kImageAlignment - 1) / kImageAlignment);
    file.seekg(0);
    file.read(reinterpret_cast<char*>(blocks_.data()), static_cast<std::streamsize>(size));
    if (!file) throw std::runtime_error(path + ": cannot read");
    const ImageResult result = open_image({reinterpret_cast<const std::byte*>(blocks_.data()), size}, model_);
    if (result.error != ImageError::kNone) {
      throw std::runtime_error(path + ": " + describe(result.error) + " (" + result.field + ")");
    }
  }
  const Model& model() const { return model_; }

 private:
  struct alignas(kImageAlignment) Block {
    std::byte bytes[kImageAlignment];
  };
  std::vector<Block> blocks_;
  Model model_;
};

}  // namespace palpate::test
