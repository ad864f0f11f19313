#include "sim_host/record/recorded_image.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

namespace palpate {

namespace {

// Of an image inside a recording, unpacked: the largest body's compliance, with room. A file that claims more is lying.
constexpr std::size_t kMostImageBytes = std::size_t{5} << 28;

}  // namespace

std::vector<PackedPiece> pack_image(std::span<const std::byte> image) {
  std::vector<PackedPiece> pieces;
  for (std::size_t at = 0; at < image.size(); at += plr::kImagePieceBytes) {
    const auto size = static_cast<uLong>(std::min<std::size_t>(plr::kImagePieceBytes, image.size() - at));
    uLongf packed = compressBound(size);
    PackedPiece piece{static_cast<std::uint32_t>(size), std::vector<std::byte>(packed)};
    if (compress2(reinterpret_cast<Bytef*>(piece.bytes.data()), &packed,
                  reinterpret_cast<const Bytef*>(image.data() + at), size, Z_NO_COMPRESSION) != Z_OK) {
      throw RecordingError("no memory to pack the scene image");
    }
    piece.bytes.resize(packed);
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

void RecordedScene::unpack(const RecordingReader& recording) {
  std::size_t total = 0;
  for (const RecordingReader::ImagePiece& piece : recording.image()) {
    if (piece.unpacked_bytes > plr::kImagePieceBytes) throw RecordingError("a piece of the image inside is too large");
    total += piece.unpacked_bytes;
  }
  if (total > kMostImageBytes) throw RecordingError("the image inside is too large to be one");
  inside_.resize((total + kImageAlignment - 1) / kImageAlignment);
  auto* at = reinterpret_cast<Bytef*>(inside_.data());
  for (const RecordingReader::ImagePiece& piece : recording.image()) {
    uLongf size = piece.unpacked_bytes;
    const int result = uncompress(at, &size, reinterpret_cast<const Bytef*>(piece.packed.data()),
                                  static_cast<uLong>(piece.packed.size()));
    if (result != Z_OK || size != piece.unpacked_bytes) throw RecordingError("the image inside cannot be unpacked");
    at += size;
  }
  const std::span bytes(reinterpret_cast<const std::byte*>(inside_.data()), total);
  const ImageResult result = open_image(bytes, model_);
  if (result.error != ImageError::kNone) {
    throw RecordingError(fmt::format("the image inside: {}: {}", result.field, describe(result.error)));
  }
}

RecordedScene::RecordedScene(const RecordingReader& recording, const std::string& image) {
  const RecordingHeader& header = recording.header();
  if (!image.empty()) {
    file_ = std::make_unique<ImageFile>(image);
    model_ = file_->model();
    source_ = image;
    return;
  }
  std::string why = "is of another scene by now";
  try {
    file_ = std::make_unique<ImageFile>(header.image_path);
    model_ = file_->model();
    source_ = header.image_path;
    if (model_.scene_hash == header.scene_hash) return;
  } catch (const std::runtime_error& error) {
    why = error.what();
  }
  if (recording.image().empty()) {
    throw RecordingError(
        fmt::format("the recording holds no image, and '{}' {}: name it with --image", header.image_path, why));
  }
  unpack(recording);
  source_ = "the image inside the recording";
  if (model_.scene_hash != header.scene_hash) throw RecordingError("the image inside is of another scene");
}

}  // namespace palpate
