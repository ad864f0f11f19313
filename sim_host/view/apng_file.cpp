#include "sim_host/view/apng_file.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace palpate {

namespace {

constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::uint8_t kBitsPerChannel = 8, kRgb = 2;

class Bytes {
 public:
  Bytes& u8(int value) {
    data.push_back(static_cast<std::uint8_t>(value));
    return *this;
  }
  Bytes& u16(int value) { return u8(value >> 8).u8(value); }
  Bytes& u32(std::uint32_t value) { return u16(static_cast<int>(value >> 16)).u16(static_cast<int>(value & 0xffff)); }
  Bytes& u32(int value) { return u32(static_cast<std::uint32_t>(value)); }
  std::vector<std::uint8_t> data;
};

// The compressed rows of a picture, as libpng writes them: what its IDAT chunks hold together.
std::vector<std::uint8_t> compressed(int width, int height, const std::vector<std::uint8_t>& rgb) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  if (png_image_write_to_memory(&image, nullptr, &size, 0, rgb.data(), 0, nullptr) == 0)
    throw std::runtime_error(std::string("a frame cannot be written: ") + image.message);
  std::vector<std::uint8_t> file(size);
  if (png_image_write_to_memory(&image, file.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
    throw std::runtime_error(std::string("a frame cannot be written: ") + image.message);
  std::vector<std::uint8_t> rows;
  for (std::size_t at = sizeof kSignature; at + 12 <= size;) {
    const std::size_t length = std::size_t{file[at]} << 24 | std::size_t{file[at + 1]} << 16 |
                               std::size_t{file[at + 2]} << 8 | std::size_t{file[at + 3]};
    const auto* data = file.data() + at + 8;
    if (std::memcmp(file.data() + at + 4, "IDAT", 4) == 0) rows.insert(rows.end(), data, data + length);
    at += 12 + length;
  }
  return rows;
}

}  // namespace

ApngFile::ApngFile(const std::string& path, int width, int height, int frames, int per_second)
    : file_(path, WhenItExists::kReplace), width_(width), height_(height), frames_(frames), per_second_(per_second) {
  file_.write(kSignature, sizeof kSignature);
  chunk("IHDR", Bytes().u32(width).u32(height).u8(kBitsPerChannel).u8(kRgb).u8(0).u8(0).u8(0).data);
  chunk("acTL", Bytes().u32(frames).u32(0).data);  // 0: for ever
}

void ApngFile::chunk(const char (&type)[5], std::span<const std::uint8_t> data) {
  uLong crc = crc32(0, reinterpret_cast<const Bytef*>(type), 4);
  if (!data.empty()) crc = crc32(crc, data.data(), static_cast<uInt>(data.size()));  // from null it begins anew
  const std::vector<std::uint8_t> length = Bytes().u32(static_cast<std::uint32_t>(data.size())).data,
                                  check = Bytes().u32(static_cast<std::uint32_t>(crc)).data;
  file_.write(length.data(), length.size());
  file_.write(type, 4);
  file_.write(data.data(), data.size());
  file_.write(check.data(), check.size());
}

ApngFile::Part ApngFile::changed(std::span<const std::uint8_t> rgb) const {
  if (last_.empty()) return {0, 0, width_, height_};
  int left = width_, right = -1, top = height_, bottom = -1;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t at =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x));
      if (std::equal(rgb.begin() + static_cast<std::ptrdiff_t>(at), rgb.begin() + static_cast<std::ptrdiff_t>(at + 3),
                     last_.begin() + static_cast<std::ptrdiff_t>(at)))
        continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = y;
    }
  }
  if (right < 0) return {0, 0, 1, 1};  // nothing: a frame must have something
  return {left, top, right - left + 1, bottom - top + 1};
}

void ApngFile::add(std::span<const std::uint8_t> rgb) {
  if (rgb.size() != std::size_t{3} * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_))
    throw std::runtime_error(file_.path() + ": a frame of another size");
  if (added_ == frames_) throw std::runtime_error(file_.path() + ": more frames than announced");
  const Part part = changed(rgb);
  std::vector<std::uint8_t> pixels;
  for (int y = part.y; y < part.y + part.height; ++y) {
    const auto row = rgb.begin() + 3 * (std::ptrdiff_t{y} * width_ + part.x);
    pixels.insert(pixels.end(), row, row + std::ptrdiff_t{3} * part.width);
  }
  constexpr int kKeep = 0, kReplace = 0;  // what is beyond the part stays; the part replaces what was there
  chunk("fcTL", Bytes()
                    .u32(sequence_++)
                    .u32(part.width)
                    .u32(part.height)
                    .u32(part.x)
                    .u32(part.y)
                    .u16(1)
                    .u16(per_second_)
                    .u8(kKeep)
                    .u8(kReplace)
                    .data);
  std::vector<std::uint8_t> rows = compressed(part.width, part.height, pixels);
  if (added_ > 0) {
    const std::vector<std::uint8_t> number = Bytes().u32(sequence_++).data;
    rows.insert(rows.begin(), number.begin(), number.end());
  }
  if (added_ == 0)
    chunk("IDAT", rows);
  else
    chunk("fdAT", rows);
  last_.assign(rgb.begin(), rgb.end());
  added_ += 1;
}

void ApngFile::finish() {
  if (added_ != frames_) throw std::runtime_error(file_.path() + ": fewer frames than announced");
  chunk("IEND", {});
  file_.finish();
}

}  // namespace palpate
