#include "sim_host/record/recording.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>

namespace palpate {

namespace {

constexpr std::uint64_t kMagic = 0x003130434552504Cull;  // bytes "LPREC01\0"
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kRecordsPerChunk = 256;
constexpr std::size_t kRecordPrefix = offsetof(TickRecord, region);
constexpr std::size_t kMostChunkBytes = kRecordsPerChunk * sizeof(TickRecord);

constexpr std::uint32_t tag_of(const char (&text)[5]) {
  std::uint32_t tag = 0;
  for (int i = 3; i >= 0; --i) tag = tag << 8 | static_cast<unsigned char>(text[i]);
  return tag;
}
constexpr std::uint32_t kHead = tag_of("HEAD");
constexpr std::uint32_t kStat = tag_of("STAT");
constexpr std::uint32_t kSlice = tag_of("SLIC");
constexpr std::uint32_t kTick = tag_of("TICK");
constexpr std::uint32_t kLost = tag_of("LOST");
constexpr std::uint32_t kEnd = tag_of("END ");

struct Prefix {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t crc;
};
struct ChunkHeader {
  std::uint32_t tag, count, bytes, crc;
};
struct SlicePayload {
  std::uint64_t first, state_known;
};
struct LostPayload {
  std::uint64_t first, number;
};
struct EndPayload {
  std::uint64_t records, lost;
};

std::uint32_t crc_of(const void* data, std::size_t bytes, std::uint32_t start = 0) {
  return static_cast<std::uint32_t>(crc32_z(start, static_cast<const Bytef*>(data), bytes));
}

std::span<const std::byte> bytes_of(const auto& value) {
  return {reinterpret_cast<const std::byte*>(&value), sizeof(value)};
}

template <std::size_t N>
void copy_text(char (&to)[N], const char (&from)[N]) {
  std::memcpy(to, from, N);
  to[N - 1] = '\0';
}

}  // namespace

RecordingHeader recording_header(const TelemetryHeader& telemetry) {
  RecordingHeader header;
  header.scene_hash = telemetry.scene_hash;
  header.period_ns = telemetry.period_ns;
  copy_text(header.scene_name, telemetry.scene_name);
  copy_text(header.build_id, telemetry.build_id);
  copy_text(header.image_path, telemetry.image_path);
  return header;
}

// Writer.

RecordingWriter::RecordingWriter(const std::string& path, RecordingHeader header, const State& initial_state)
    : path_(path) {
  fd_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd_ < 0) throw RecordingError(fmt::format("{}: cannot create the recording: {}", path, std::strerror(errno)));
  Prefix prefix{kMagic, kVersion, 0};
  prefix.crc = crc_of(&prefix, offsetof(Prefix, crc));
  header.initial_state_hash = crc_of(&initial_state, sizeof(State));
  write_all(&prefix, sizeof(prefix));
  write_chunk(kHead, 1, bytes_of(header));
  write_chunk(kStat, 1, bytes_of(initial_state));
}

RecordingWriter::~RecordingWriter() {
  if (fd_ >= 0) close(fd_);
}

void RecordingWriter::write_all(const void* data, std::size_t bytes) {
  const auto* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = write(fd_, at, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw RecordingError(fmt::format("{}: cannot write: {}", path_, std::strerror(errno)));
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void RecordingWriter::write_chunk(std::uint32_t tag, std::uint32_t count, std::span<const std::byte> payload) {
  ChunkHeader header{tag, count, static_cast<std::uint32_t>(payload.size()), 0};
  header.crc = crc_of(payload.data(), payload.size(), crc_of(&header, offsetof(ChunkHeader, crc)));
  // One write for both, so a process killed between two system calls leaves no half chunk.
  std::vector<std::byte> whole(sizeof(header) + payload.size());
  std::memcpy(whole.data(), &header, sizeof(header));
  if (!payload.empty()) std::memcpy(whole.data() + sizeof(header), payload.data(), payload.size());
  write_all(whole.data(), whole.size());
}

void RecordingWriter::begin_slice(std::uint64_t first, bool state_known) {
  write_chunk(kSlice, 1, bytes_of(SlicePayload{first, state_known ? 1u : 0u}));
}

void RecordingWriter::add(const TickRecord& record) {
  const std::int32_t regions = record.region_count < 0             ? 0
                               : record.region_count > kMaxRegions ? kMaxRegions
                                                                   : record.region_count;
  const std::size_t bytes = kRecordPrefix + static_cast<std::size_t>(regions) * sizeof(RegionRecord);
  const std::size_t at = pending_.size();
  pending_.resize(at + bytes);
  std::memcpy(pending_.data() + at, &record, bytes);
  std::memcpy(pending_.data() + at + offsetof(TickRecord, region_count), &regions, sizeof(regions));
  pending_records_ += 1;
  records_ += 1;
  if (pending_records_ == kRecordsPerChunk) flush();
}

void RecordingWriter::add_lost(std::uint64_t first, std::uint64_t number) {
  flush();
  lost_ += number;
  write_chunk(kLost, 1, bytes_of(LostPayload{first, number}));
}

void RecordingWriter::flush() {
  if (pending_records_ == 0) return;
  write_chunk(kTick, pending_records_, pending_);
  pending_.clear();
  pending_records_ = 0;
}

void RecordingWriter::finish() {
  flush();
  write_chunk(kEnd, 1, bytes_of(EndPayload{records_, lost_}));
  // EINVAL: not a file that can be synchronised (a pipe), nothing to do.
  if (fsync(fd_) != 0 && errno != EINVAL) {
    throw RecordingError(fmt::format("{}: fsync: {}", path_, std::strerror(errno)));
  }
}

// Reader.

RecordingReader::RecordingReader(std::span<const std::byte> bytes) : bytes_(bytes) {
  read_prefix();
  const Chunk head = expect_chunk(kHead, sizeof(RecordingHeader));
  std::memcpy(&header_, head.payload.data(), sizeof(header_));
  if (header_.layout_hash != kRecordLayoutHash) {
    throw RecordingError(fmt::format(
        "the recording has another data layout ({:016x}) than this build ({:016x}): replay it with the build "
        "that made it: {:.{}}",
        header_.layout_hash, kRecordLayoutHash, static_cast<const char*>(header_.build_id),
        strnlen(header_.build_id, kBuildIdBytes)));
  }
  copy_text(header_.scene_name, header_.scene_name);
  copy_text(header_.build_id, header_.build_id);
  copy_text(header_.image_path, header_.image_path);
  const Chunk state = expect_chunk(kStat, sizeof(State));
  std::memcpy(static_cast<void*>(&initial_state_), state.payload.data(), sizeof(State));
  if (header_.initial_state_hash != crc_of(state.payload.data(), sizeof(State))) {
    throw RecordingError(fmt::format("offset {}: the initial state is not the one the header names", chunk_offset_));
  }
  read_slice();
}

// The chunk of a slice, if it is there: whatever else follows is left to next().
void RecordingReader::read_slice() {
  std::uint32_t tag = 0;
  if (bytes_.size() - offset_ < sizeof(ChunkHeader)) return;
  std::memcpy(&tag, bytes_.data() + offset_, sizeof(tag));
  if (tag != kSlice) return;
  const Chunk chunk = expect_chunk(kSlice, sizeof(SlicePayload));
  SlicePayload slice;
  std::memcpy(&slice, chunk.payload.data(), sizeof(slice));
  first_sequence_ = slice.first;
  state_known_ = slice.state_known != 0;
}

void RecordingReader::extend(std::span<const std::byte> bytes) {
  bytes_ = bytes;
  if (!cut_ || bytes.size() < offset_) return;
  cut_ = false;
  error_.clear();
}

void RecordingReader::read_prefix() {
  Prefix prefix;
  if (bytes_.size() < sizeof(prefix)) throw RecordingError("offset 0: too short to be a recording");
  std::memcpy(&prefix, bytes_.data(), sizeof(prefix));
  if (prefix.magic != kMagic) throw RecordingError("offset 0: not a Palpate recording (magic)");
  if (prefix.crc != crc_of(&prefix, offsetof(Prefix, crc))) throw RecordingError("offset 8: damaged prefix (checksum)");
  if (prefix.version != kVersion) {
    throw RecordingError(fmt::format("offset 8: recording version {}, this build reads {}", prefix.version, kVersion));
  }
  offset_ = sizeof(prefix);
}

// Reads and checks the chunk at offset_; throws, leaving offset_ there, when it is damaged or cut.
RecordingReader::Chunk RecordingReader::read_chunk() {
  chunk_offset_ = offset_;
  cut_ = true;  // until the chunk is seen to be whole
  ChunkHeader header;
  const std::size_t left = bytes_.size() - offset_;
  if (left == 0) throw RecordingError(fmt::format("offset {}: the recording ends without its footer", offset_));
  if (left < sizeof(header)) throw RecordingError(fmt::format("offset {}: cut off inside a chunk header", offset_));
  std::memcpy(&header, bytes_.data() + offset_, sizeof(header));
  if (header.bytes > kMostChunkBytes) {
    cut_ = false;
    throw RecordingError(fmt::format("offset {}: damaged chunk size", offset_));
  }
  if (header.bytes > left - sizeof(header)) {
    throw RecordingError(
        fmt::format("offset {}: chunk cut off: {} of {} bytes", offset_, left - sizeof(header), header.bytes));
  }
  cut_ = false;
  const Chunk chunk{header.tag, header.count, bytes_.subspan(offset_ + sizeof(header), header.bytes)};
  if (header.crc != crc_of(chunk.payload.data(), chunk.payload.size(), crc_of(&header, offsetof(ChunkHeader, crc)))) {
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
      if (chunk.tag == kTick && chunk.count <= kRecordsPerChunk) {
        ticks_ = chunk.payload;
        ticks_left_ = chunk.count;
      } else if (chunk.tag == kLost && chunk.payload.size() == sizeof(LostPayload)) {
        LostPayload lost;
        std::memcpy(&lost, chunk.payload.data(), sizeof(lost));
        lost_ += lost.number;
      } else if (chunk.tag == kEnd && chunk.payload.size() == sizeof(EndPayload)) {
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
  const bool prefix = ticks_.size() >= kRecordPrefix;
  if (prefix) std::memcpy(static_cast<void*>(&record), ticks_.data(), kRecordPrefix);
  const bool counted = prefix && record.region_count >= 0 && record.region_count <= kMaxRegions;
  const std::size_t regions = counted ? static_cast<std::size_t>(record.region_count) * sizeof(RegionRecord) : 0;
  if (!counted || ticks_.size() - kRecordPrefix < regions) {
    throw RecordingError(fmt::format("offset {}: chunk with a malformed record", chunk_offset_));
  }
  std::memcpy(static_cast<void*>(record.region), ticks_.data() + kRecordPrefix, regions);
  ticks_ = ticks_.subspan(kRecordPrefix + regions);
  ticks_left_ -= 1;
  records_ += 1;
}

void RecordingReader::finish(const Chunk& chunk) {
  EndPayload end;
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

MappedFile::MappedFile(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) throw RecordingError(fmt::format("{}: cannot open: {}", path, std::strerror(errno)));
  struct stat status {};
  const bool sized = fstat(fd, &status) == 0 && status.st_size > 0;
  void* data =
      sized ? mmap(nullptr, static_cast<std::size_t>(status.st_size), PROT_READ, MAP_PRIVATE, fd, 0) : MAP_FAILED;
  close(fd);
  if (data == MAP_FAILED) throw RecordingError(fmt::format("{}: empty, or not a file that can be mapped", path));
  data_ = static_cast<const std::byte*>(data);
  size_ = static_cast<std::size_t>(status.st_size);
}

MappedFile::~MappedFile() { munmap(const_cast<std::byte*>(data_), size_); }

}  // namespace palpate
