#include "config/bake/image_writer.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "config/scene/config_error.h"
#include "rt_core/image.h"

namespace palpate {

ModelSizes sizes_of(const ImageContents& contents) {
  ModelSizes sizes{};
  const auto n = [](const auto& v) { return static_cast<std::int64_t>(v.size()); };
  sizes.n_anchor = n(contents.anchor);
  const std::int64_t tail = contents.params.rbf_tail == RbfTail::kLinear ? 4 : 1;
  sizes.n_rbf = contents.rbf_inverse.empty() ? 0 : sizes.n_anchor + tail;
#define PALPATE_FIELD(type, name, count, frame, meaning) sizes.count = n(contents.name);
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return sizes;
}

std::vector<ArrayBytes> array_bytes(const ImageContents& contents) {
  std::vector<ArrayBytes> sizes;
#define PALPATE_FIELD(type, name, count, frame, meaning) sizes.push_back({#name, contents.name.size() * sizeof(type)});
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return sizes;
}

std::vector<std::byte> write_image(const ImageContents& contents) {
  const ModelSizes sizes = sizes_of(contents);
  if (contents.vertex_m.size() != contents.vertex_normal.size())
    throw ConfigError("image: as many vertex normals as vertices are needed");
  std::uint64_t offset[kArrayCount + 1];
  if (!image_offsets(sizes, offset)) throw ConfigError("image: an array is empty or larger than the format allows");

  std::vector<std::byte> bytes(offset[kArrayCount], std::byte{0});
  std::size_t index = 0;
#define PALPATE_FIELD(type, name, count, frame, meaning)                                                  \
  if (!contents.name.empty())                                                                             \
    std::memcpy(bytes.data() + offset[index], contents.name.data(), contents.name.size() * sizeof(type)); \
  ++index;
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
  const ImageSections sections = image_sections();
  std::memcpy(bytes.data() + sections.sizes, &sizes, sizeof sizes);
  // Field by field: what lies between them stays zero.
#define PALPATE_FIELD(type, name, unit, lowest, highest, meaning) \
  std::memcpy(bytes.data() + sections.params + offsetof(ModelParams, name), &contents.params.name, sizeof(type));
  PALPATE_MODEL_PARAMS(PALPATE_FIELD)
#undef PALPATE_FIELD

  ImageHeader header{};
  header.magic = kImageMagic;
  header.version = kImageVersion;
  header.real_bytes = sizeof(Real);
  header.layout_hash = image_layout_hash();
  header.total_bytes = bytes.size();
  contents.name.copy(header.name, kNameBytes - 1);
  std::memcpy(bytes.data(), &header, sizeof header);
  header.checksum = image_checksum(bytes);
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

bool save_image(const std::string& path, const std::vector<std::byte>& bytes, std::string& error) {
  // Renaming onto a device node puts a file in its place: root's `palpate bake -o /dev/null` did (2026-11-22).
  std::error_code none;
  if (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none)) {
    error = path + ": is no ordinary file and is not replaced; choose another name";
    return false;
  }
  // A new file of its own name: what lies at a name that can be guessed, a link say, is never written through.
  std::string temporary = path + ".XXXXXX";
  const int fd = mkostemp(temporary.data(), O_CLOEXEC);
  std::FILE* file = fd >= 0 && fchmod(fd, 0644) == 0 ? fdopen(fd, "wb") : nullptr;
  if (file == nullptr) {
    error = path + ": cannot write: " + std::strerror(errno) + "; check that the folder exists and is writable";
    return false;
  }
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const bool closed = std::fclose(file) == 0;
  if (!written || !closed || std::rename(temporary.c_str(), path.c_str()) != 0) {
    error = path + ": cannot write: " + std::strerror(errno) + "; check the free space";
    std::remove(temporary.c_str());
    return false;
  }
  return true;
}

}  // namespace palpate
