// Writes scene images: the counterpart of open_image, laid out from the same tables.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rt_core/model.h"

namespace palpate {

// Contents of an image before it is written: the arrays of the model table as vectors.
struct ImageContents {
  std::string name;
  ModelParams params{};
#define PALPATE_FIELD(type, name, count, frame, meaning) std::vector<type> name;
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
};

// Sizes of the arrays as they stand.
ModelSizes sizes_of(const ImageContents& contents);

// Size of one array of the image.
struct ArrayBytes {
  const char* name;
  std::size_t bytes;
};
std::vector<ArrayBytes> array_bytes(const ImageContents& contents);

// Bytes of the image: header, sizes, parameters, arrays, checksum; unused bytes are zero, so the same contents always
// give the same bytes. Throws ConfigError when an array's size is out of the format's range. Does not check contents:
// open_image does.
std::vector<std::byte> write_image(const ImageContents& contents);

// Writes to a temporary file beside `path` and renames it, so that a reader never sees half an image. Returns false
// and the reason in `error`.
bool save_image(const std::string& path, const std::vector<std::byte>& bytes, std::string& error);

// Sizes, parameters and arrays of the format as Markdown tables: the generated part of docs/image_format.md.
std::string image_markdown();

}  // namespace palpate
