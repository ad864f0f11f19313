#include "config/bake/opened_image.h"

#include <algorithm>
#include <new>

namespace palpate {

OpenedImage::OpenedImage(std::span<const std::byte> bytes)
    : size_(bytes.size()),
      at_(static_cast<std::byte*>(::operator new (bytes.size(), std::align_val_t{kImageAlignment}))) {
  std::copy(bytes.begin(), bytes.end(), at_.get());
  result_ = open_image(this->bytes(), model_);
}

}  // namespace palpate
