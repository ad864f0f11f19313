// An image in memory where open_image wants it: aligned, and checked completely.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "rt_core/image.h"

namespace palpate {

class OpenedImage {
 public:
  // Copies `bytes`. `result` tells whether they are an image; unless they are, model() is not to be used.
  explicit OpenedImage(std::span<const std::byte> bytes);
  const ImageResult& result() const { return result_; }
  const Model& model() const { return model_; }
  Model& model() { return model_; }
  std::span<const std::byte> bytes() const { return {at_.get(), size_}; }

 private:
  struct Release {
    void operator()(std::byte* p) const { ::operator delete (p, std::align_val_t{kImageAlignment}); }
  };
  std::size_t size_;
  std::unique_ptr<std::byte, Release> at_;
  Model model_;
  ImageResult result_;
};

}  // namespace palpate
