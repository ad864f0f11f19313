#include "sim_host/record/recording_reader.h"

#include <fmt/format.h>

#include <cstring>

#include "sim_host/record/state_check.h"

namespace palpate {

RecordingReader::RecordingReader(std::span<const std::byte> bytes) : bytes_(bytes) {
  read_prefix();
  const Chunk head = expect_chunk(plr::kHead, sizeof(RecordingHeader));
  std::memcpy(&header_, head.payload.data(), sizeof(header_));
  if (header_.layout_hash != kRecordLayoutHash) {
    throw RecordingError(fmt::format(
        "the recording has another data layout ({:016x}) than this build ({:016x}): replay it with the build "
        "that made it: {:.{}}",
        header_.layout_hash, kRecordLayoutHash, static_cast<const char*>(header_.build_id),
        strnlen(header_.build_id, kBuildIdBytes)));
  }
  header_.scene_name[kNameBytes - 1] = header_.build_id[kBuildIdBytes - 1] = '\0';
  header_.image_path[kImagePathBytes - 1] = '\0';
  const Chunk state = read_chunk();
  if (state.tag != plr::kState) throw RecordingError(fmt::format("offset {}: unexpected chunk", chunk_offset_));
  initial_state_.assign(state.payload.begin(), state.payload.end());
  if (header_.initial_state_hash != plr::crc32(initial_state_.data(), initial_state_.size())) {
    throw RecordingError(fmt::format("offset {}: the initial state is not the one the header names", chunk_offset_));
  }
  read_image();
  read_slice();
}

// Tag of the chunk at offset_; 0 when not even its header is there.
std::uint32_t RecordingReader::next_tag() const {
  std::uint32_t tag = 0;
  if (bytes_.size() - offset_ >= sizeof(plr::ChunkHeader)) std::memcpy(&tag, bytes_.data() + offset_, sizeof(tag));
  return tag;
}

// The chunks of the image, as far as they are whole: whatever else follows is left to next().
void RecordingReader::read_image() {
  while (next_tag() == plr::kImage) {  // bound: chunks of the file
    const std::size_t before = offset_;
    try {
      const Chunk chunk = read_chunk();
      image_.push_back({chunk.count, chunk.payload});
    } catch (const RecordingError&) {
      offset_ = before;
      return;
    }
  }
}

// The chunk of a slice, if it is there: whatever else follows is left to next().
void RecordingReader::read_slice() {
  if (next_tag() != plr::kSlice) return;
  const Chunk chunk = expect_chunk(plr::kSlice, sizeof(plr::Slice));
  plr::Slice slice;
  std::memcpy(&slice, chunk.payload.data(), sizeof(slice));
  first_sequence_ = slice.first;
  state_known_ = slice.state_known != 0;
}

StatePtr RecordingReader::initial_state(const Model& model) const {
  StatePtr state = make_state(model);
  const bool fits = initial_state_.size() == state->bytes;
  if (fits) std::memcpy(static_cast<void*>(state.get()), initial_state_.data(), initial_state_.size());
  const StateFault fault = fits ? check_state(model, *state) : StateFault{"its size"};
  if (fault.field == nullptr) return state;
  const std::string at = fault.index >= 0 ? fmt::format("[{}]", fault.index) : "";
  throw RecordingError(
      fmt::format("the recording's initial state is one this scene cannot have: {}{}; the file was made or changed by "
                  "something else than palpate, or with another scene",
                  fault.field, at));
}

void RecordingReader::extend(std::span<const std::byte> bytes) {
  for (ImagePiece& piece : image_) {
    piece.packed = bytes.subspan(static_cast<std::size_t>(piece.packed.data() - bytes_.data()), piece.packed.size());
  }
  bytes_ = bytes;
  if (!cut_ || bytes.size() < offset_) return;
  cut_ = false;
  error_.clear();
}

void RecordingReader::read_prefix() {
  plr::Prefix prefix;
  if (bytes_.size() < sizeof(prefix)) throw RecordingError("offset 0: too short to be a recording");
  std::memcpy(&prefix, bytes_.data(), sizeof(prefix));
  if (prefix.magic != plr::kMagic) throw RecordingError("offset 0: not a Palpate recording (magic)");
  if (prefix.crc != plr::crc32(&prefix, offsetof(plr::Prefix, crc)))
    throw RecordingError("offset 8: damaged prefix (checksum)");
  if (prefix.version != plr::kVersion) {
    throw RecordingError(
        fmt::format("offset 8: recording version {}, this build reads {}", prefix.version, plr::kVersion));
  }
  offset_ = sizeof(prefix);
}

// Reads and checks the chunk at offset_; throws, leaving offset_ there, when it is damaged or cut.
RecordingReader::Chunk RecordingReader::read_chunk() {
  chunk_offset_ = offset_;
  cut_ = true;  // until the chunk is seen to be whole
  plr::ChunkHeader header;
  const std::size_t left = bytes_.size() - offset_;
  if (left == 0) throw RecordingError(fmt::format("offset {}: the recording ends without its footer", offset_));
  if (left < sizeof(header)) throw RecordingError(fmt::format("offset {}: cut off inside a chunk header", offset_));
  std::memcpy(&header, bytes_.data() + offset_, sizeof(header));
  if (header.bytes > plr::kMostChunkBytes) {
    cut_ = false;
    throw RecordingError(fmt::format("offset {}: damaged chunk size", offset_));
  }
  if (header.bytes > left - sizeof(header)) {
    throw RecordingError(
        fmt::format("offset {}: chunk cut off: {} of {} bytes", offset_, left - sizeof(header), header.bytes));
  }
  cut_ = false;
  const Chunk chunk{header.tag, header.count, bytes_.subspan(offset_ + sizeof(header), header.bytes)};
  if (header.crc !=
      plr::crc32(chunk.payload.data(), chunk.payload.size(), plr::crc32(&header, offsetof(plr::ChunkHeader, crc)))) {
    throw RecordingError(fmt::format("offset {}: damaged chunk (checksum)", offset_));
  }
  offset_ += sizeof(header) + header.bytes;
  return chunk;
}

RecordingReader::Chunk RecordingReader::expect_chunk(std::uint32_t tag, std::size_t bytes) {
  const Chunk chunk = read_chunk();
  if (chunk.tag != tag) throw RecordingError(fmt::format("offset {}: unexpected chunk", chunk_offset_));
  if (chunk.payload.size() != bytes) {
    // A header that grew or shrank is another layout, not damage: the checksum was right.
    throw RecordingError(
        fmt::format("offset {}: the recording has another data layout than this build ({} bytes here, "
                    "{} expected): replay it with the build that made it",
                    chunk_offset_, chunk.payload.size(), bytes));
  }
  return chunk;
}

bool RecordingReader::next(TickRecord& record) {
  try {
    while (ticks_left_ == 0) {  // bound: chunks of the file
      if (ended_ || !error_.empty()) return false;
      const Chunk chunk = read_chunk();
      if (chunk.tag == plr::kTick && chunk.count <= plr::kRecordsPerChunk) {
        ticks_ = chunk.payload;
        ticks_left_ = chunk.count;
      } else if (chunk.tag == plr::kLost && chunk.payload.size() == sizeof(plr::Lost)) {
        plr::Lost lost;
        std::memcpy(&lost, chunk.payload.data(), sizeof(lost));
        lost_ += lost.number;
      } else if (chunk.tag == plr::kImage && records_ == 0) {  // was not whole when the reader was made
        image_.push_back({chunk.count, chunk.payload});
      } else if (chunk.tag == plr::kEnd && chunk.payload.size() == sizeof(plr::End)) {
        finish(chunk);
        return false;
      } else {
        throw RecordingError(fmt::format("offset {}: unexpected chunk", chunk_offset_));
      }
    }
    decode(record);
  } catch (const RecordingError& error) {
    error_ = fmt::format("{}; the {} records before it are intact", error.what(), records_);
    ticks_left_ = 0;
    return false;
  }
  return true;
}

void RecordingReader::decode(TickRecord& record) {
  std::memset(static_cast<void*>(&record), 0, sizeof(record));
  const bool prefix = ticks_.size() >= plr::kRecordPrefix;
  if (prefix) std::memcpy(static_cast<void*>(&record), ticks_.data(), plr::kRecordPrefix);
  const bool counted = prefix && record.region_count >= 0 && record.region_count <= kMaxRegions;
  const std::size_t regions = counted ? static_cast<std::size_t>(record.region_count) * sizeof(RegionRecord) : 0;
  if (!counted || ticks_.size() - plr::kRecordPrefix < regions) {
    throw RecordingError(fmt::format("offset {}: chunk with a malformed record", chunk_offset_));
  }
  std::memcpy(static_cast<void*>(record.region), ticks_.data() + plr::kRecordPrefix, regions);
  ticks_ = ticks_.subspan(plr::kRecordPrefix + regions);
  ticks_left_ -= 1;
  records_ += 1;
}

void RecordingReader::finish(const Chunk& chunk) {
  plr::End end;
  std::memcpy(&end, chunk.payload.data(), sizeof(end));
  ended_ = true;
  if (end.records != records_ || end.lost != lost_) {
    throw RecordingError(fmt::format("offset {}: the footer counts {} records and {} lost, found {} and {}",
                                     chunk_offset_, end.records, end.lost, records_, lost_));
  }
  if (offset_ != bytes_.size()) {
    throw RecordingError(fmt::format("offset {}: {} bytes after the footer", offset_, bytes_.size() - offset_));
  }
}

}  // namespace palpate
