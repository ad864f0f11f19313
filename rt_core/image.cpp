#include "rt_core/image.h"

#include <cstring>

#include "rt_core/certificate.h"
#include "rt_core/hash.h"
#include "rt_core/image_check.h"

namespace palpate {

namespace {

constexpr std::size_t kSizesOffset = (sizeof(ImageHeader) + kImageAlignment - 1) / kImageAlignment * kImageAlignment;
constexpr std::size_t kParamsOffset =
    (kSizesOffset + sizeof(ModelSizes) + kImageAlignment - 1) / kImageAlignment * kImageAlignment;
constexpr std::size_t kArraysOffset =
    (kParamsOffset + sizeof(ModelParams) + kImageAlignment - 1) / kImageAlignment * kImageAlignment;

void add_text(Hasher& hasher, const char* text) noexcept {
  for (; *text != '\0'; ++text) hasher.add(static_cast<std::uint32_t>(*text));
}

// What the numbers of a choice stand for is part of the layout.
template <class T>
void add_words(Hasher& hasher) noexcept {
  if constexpr (Choice<T>)
    for (const char* word : ChoiceOf<T>::kWord) add_text(hasher, word);
}

void add_bytes(Hasher& hasher, std::span<const std::byte> bytes) noexcept {
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data() + i, 8);
    hasher.add(word);
  }
  for (; i < bytes.size(); ++i) hasher.add(static_cast<std::uint64_t>(bytes[i]));
}

ImageResult check_header(std::span<const std::byte> bytes, const ImageHeader& header) noexcept {
  if (header.magic != kImageMagic) return {ImageError::kMagic, "magic"};
  if (header.version != kImageVersion) return {ImageError::kVersion, "version"};
  if (header.real_bytes != sizeof(Real)) return {ImageError::kRealSize, "real_bytes"};
  if (header.layout_hash != image_layout_hash()) return {ImageError::kLayout, "layout_hash"};
  if (header.total_bytes < kArraysOffset || header.total_bytes > bytes.size())
    return {ImageError::kTotalSize, "total_bytes"};
  if (header.checksum != image_checksum(bytes.first(header.total_bytes))) return {ImageError::kChecksum, "checksum"};
  if (std::memchr(header.name, '\0', sizeof(header.name)) == nullptr) return {ImageError::kName, "name"};
  return {};
}

ImageResult check_params(const ModelParams& params) noexcept {
  // Written so that NaN fails.
#define PALPATE_CHECK(type, name, unit, lowest, highest, meaning)          \
  if (!(static_cast<double>(params.name) >= static_cast<double>(lowest) && \
        static_cast<double>(params.name) <= static_cast<double>(highest))) \
    return {ImageError::kParamRange, #name, -1, static_cast<double>(lowest), static_cast<double>(highest)};
  PALPATE_MODEL_PARAMS(PALPATE_CHECK)
#undef PALPATE_CHECK
  return {};
}

template <class T>
std::span<const T> view(std::span<const std::byte> bytes, std::uint64_t offset, std::int64_t count) noexcept {
  return {reinterpret_cast<const T*>(bytes.data() + offset), static_cast<std::size_t>(count)};
}

}  // namespace

std::uint64_t image_layout_hash() noexcept {
  Hasher hasher;
  hasher.add(static_cast<std::uint64_t>(kArraysOffset));
#define PALPATE_FIELD(type, name, unit, lowest, highest, meaning) \
  add_text(hasher, #type " " #name " " unit);                     \
  add_words<type>(hasher);
  PALPATE_MODEL_PARAMS(PALPATE_FIELD)
#undef PALPATE_FIELD
#define PALPATE_FIELD(type, name, count, frame, meaning)  \
  add_text(hasher, #type " " #name " " #count " " frame); \
  hasher.add(static_cast<std::uint64_t>(sizeof(type)));
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
#define PALPATE_FIELD(name, lowest, highest, methods) add_text(hasher, #name);
  PALPATE_MODEL_SIZES(PALPATE_FIELD)
#undef PALPATE_FIELD
  return hasher.value;
}

std::uint64_t image_checksum(std::span<const std::byte> bytes) noexcept {
  constexpr std::size_t kAfter = offsetof(ImageHeader, checksum) + sizeof(ImageHeader::checksum);
  Hasher hasher;
  add_bytes(hasher, bytes.first(offsetof(ImageHeader, checksum)));
  add_bytes(hasher, bytes.subspan(kAfter));
  return hasher.value;
}

std::uint64_t bytes_checksum(std::span<const std::byte> bytes) noexcept {
  Hasher hasher;
  add_bytes(hasher, bytes);
  return hasher.value;
}

ImageSections image_sections() noexcept { return {kSizesOffset, kParamsOffset, kArraysOffset}; }

bool image_offsets(const ModelSizes& sizes, std::uint64_t (&offset)[kArrayCount + 1]) noexcept {
#define PALPATE_CHECK(name, lowest, highest, methods) \
  if (!(sizes.name >= (lowest) && sizes.name <= (highest))) return false;
  PALPATE_MODEL_SIZES(PALPATE_CHECK)
#undef PALPATE_CHECK
  // No overflow: every count is at most 2^28 and every element smaller than 2^8 bytes.
  std::uint64_t at = kArraysOffset;
  std::size_t index = 0;
#define PALPATE_FIELD(type, name, count, frame, meaning)        \
  static_assert(sizeof(type) < 256);                            \
  offset[index++] = at;                                         \
  at += static_cast<std::uint64_t>(sizes.count) * sizeof(type); \
  at = (at + kImageAlignment - 1) / kImageAlignment * kImageAlignment;
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
  offset[index] = at;
  return true;
}

ImageResult open_image(std::span<const std::byte> bytes, Model& model) noexcept {
  if (bytes.size() < kArraysOffset) return {ImageError::kTooShort, "header"};
  if (reinterpret_cast<std::uintptr_t>(bytes.data()) % kImageAlignment != 0) return {ImageError::kMisaligned, "image"};
  const auto& header = *reinterpret_cast<const ImageHeader*>(bytes.data());
  if (const ImageResult result = check_header(bytes, header); result.error != ImageError::kNone) return result;

  Model opened;
  std::memcpy(&opened.sizes, bytes.data() + kSizesOffset, sizeof(ModelSizes));
  std::memcpy(&opened.params, bytes.data() + kParamsOffset, sizeof(ModelParams));
#define PALPATE_CHECK(name, lowest, highest, methods) \
  if (!(opened.sizes.name >= (lowest) && opened.sizes.name <= (highest))) return {ImageError::kSizeRange, #name};
  PALPATE_MODEL_SIZES(PALPATE_CHECK)
#undef PALPATE_CHECK
  std::uint64_t offset[kArrayCount + 1];
  if (!image_offsets(opened.sizes, offset) || offset[kArrayCount] != header.total_bytes)
    return {ImageError::kArrayBounds, "arrays"};
  if (const ImageResult result = check_params(opened.params); result.error != ImageError::kNone) return result;

  std::size_t index = 0;
#define PALPATE_FIELD(type, name, count, frame, meaning) \
  opened.name = view<type>(bytes, offset[index++], opened.sizes.count);
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
  if (const ImageResult result = check_arrays(opened); result.error != ImageError::kNone) return result;
  Certificate certificate;
  const ImageResult said = open_certificate(bytes.subspan(header.total_bytes), header.checksum, certificate);
  if (said.error != ImageError::kNone) return said;
  opened.scene_hash = header.checksum;
  opened.name = header.name;
  model = opened;
  return {};
}

const char* describe(ImageError error) noexcept {
  switch (error) {
    case ImageError::kNone:
      return "no error";
    case ImageError::kTooShort:
      return "the file is shorter than an image header: truncated, or not a scene image";
    case ImageError::kMagic:
      return "the file does not start with the image signature: not a scene image";
    case ImageError::kVersion:
      return "the image was written for another format version";
    case ImageError::kRealSize:
      return "the image stores another floating-point size";
    case ImageError::kLayout:
      return "the image was written by a build with another data layout";
    case ImageError::kTotalSize:
      return "the file's length differs from the one it declares: truncated or appended to";
    case ImageError::kMisaligned:
      return "the image is not aligned to 64 bytes in memory: map the file instead";
    case ImageError::kChecksum:
      return "the checksum does not match: the file is damaged";
    case ImageError::kName:
      return "the scene name is not terminated";
    case ImageError::kSizeRange:
      return "an array size is outside its range";
    case ImageError::kArrayBounds:
      return "the arrays do not fill the file exactly";
    case ImageError::kParamRange:
      return "a parameter is outside its range or not a number";
    case ImageError::kCrossReference:
      return "an index points outside the array it refers to, or a structure is broken";
    case ImageError::kNotFinite:
      return "a number is not finite";
    case ImageError::kCombination:
      return "two things of the scene do not go together";
  }
  return "unknown error";
}

}  // namespace palpate
