// The image file: header, sizes, parameters, arrays, checksum. `open_image` is the loader ladder: each rung has its own
// error and names the field, and nothing is used before it has been checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/model.h"

namespace palpate {

inline constexpr std::uint64_t kImageMagic = 0x0031304C41504C50ull;  // bytes "PLPAL01\0"
inline constexpr std::uint32_t kImageVersion = 1;
inline constexpr std::size_t kImageAlignment = 64;

struct ImageHeader {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t real_bytes;   // sizeof(Real)
  std::uint64_t layout_hash;  // of every table entry and struct size: changes whenever the meaning of the bytes changes
  std::uint64_t total_bytes;  // of the image; what follows is its certificate (rt_core/certificate.h)
  std::uint64_t checksum;     // of all bytes after this header, mixed with the header fields before this one
  char name[kNameBytes];      // scene name, zero-terminated
};

enum class ImageError : std::int32_t {
  kNone = 0,
  kTooShort,
  kMagic,
  kVersion,
  kRealSize,
  kLayout,
  kTotalSize,
  kMisaligned,
  kChecksum,
  kName,
  kSizeRange,
  kArrayBounds,
  kParamRange,
  kCrossReference,
  kNotFinite,
  kCombination,
};

struct ImageResult {
  ImageError error = ImageError::kNone;
  const char* field = "";          // static text naming the offending field
  std::int64_t index = -1;         // element within it, where that makes sense
  double lowest = 0, highest = 0;  // kParamRange: what is allowed
};

// Hash of the image layout this build writes and reads.
std::uint64_t image_layout_hash() noexcept;
// Checksum of an image's bytes (see ImageHeader::checksum). `bytes` holds at least a header.
std::uint64_t image_checksum(std::span<const std::byte> bytes) noexcept;
// Of any bytes; every single changed byte changes it.
std::uint64_t bytes_checksum(std::span<const std::byte> bytes) noexcept;
// Byte offsets of the fixed sections after the header.
struct ImageSections {
  std::size_t sizes, params, arrays;
};
ImageSections image_sections() noexcept;
// Byte offset of each array for the given sizes, in table order, after the params; the last entry is the total size.
// Returns false when a size is out of range or the sum overflows.
#define PALPATE_COUNT(type, name, count, frame, meaning) +1
inline constexpr std::size_t kArrayCount = 0 PALPATE_MODEL_ARRAYS(PALPATE_COUNT);
#undef PALPATE_COUNT
bool image_offsets(const ModelSizes& sizes, std::uint64_t (&offset)[kArrayCount + 1]) noexcept;
// Validates `bytes` (aligned to kImageAlignment) completely and binds the views. On error `model` is untouched.
ImageResult open_image(std::span<const std::byte> bytes, Model& model) noexcept;
// Plain-words meaning of an error, for the host.
const char* describe(ImageError error) noexcept;

}  // namespace palpate
