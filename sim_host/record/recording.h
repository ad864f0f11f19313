// The recording file (.plr): what a replay needs to reproduce a run bit by bit, and what every tool that draws a run
// reads. Little-endian.
//
//   8 bytes magic "LPREC01\0", u32 version, u32 CRC-32 of those 12 bytes
//   chunks: u32 tag, u32 count, u32 payload bytes, u32 CRC-32 of the 12 bytes before and of the payload; payload
//     HEAD  one RecordingHeader        first
//     STAT  one State: initial state   second
//     SLIC  {first sequence, 1 if STAT is the state before it}: only in a slice of a longer run, third
//     TICK  `count` records: TickRecord up to `region`, then region_count RegionRecords each
//     LOST  {first sequence, number}: records the recorder did not get
//     END   {records, lost}: the recording was finished properly; nothing follows
//
// Every byte lies under a checksum. A damaged or cut file is reported with the offset of the first bad chunk, and
// everything before it stays readable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "rt_core/record.h"
#include "rt_core/telemetry.h"

namespace palpate {

// Anything wrong with a recording; what() is one sentence for the user.
struct RecordingError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RecordingHeader {
  std::uint64_t layout_hash = kRecordLayoutHash;
  std::uint64_t scene_hash = 0;          // checksum of the image
  std::uint64_t initial_state_hash = 0;  // CRC-32 of the State's bytes: a second, independent look at chunk STAT
  std::int64_t period_ns = 0;
  char scene_name[kNameBytes] = {};
  char build_id[kBuildIdBytes] = {};
  char image_path[kImagePathBytes] = {};
};

// The header of a run whose controller shares `telemetry`. The texts are terminated, whatever the region holds.
RecordingHeader recording_header(const TelemetryHeader& telemetry);

// Writes a recording. Every function throws RecordingError when the file system refuses.
class RecordingWriter {
 public:
  RecordingWriter(const std::string& path, RecordingHeader header, const State& initial_state);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  // Before the first add(): this is a slice of a longer run, whose first record has sequence `first`. `state_known`:
  // the initial state is the one before that record; otherwise the slice can be listed but not replayed.
  void begin_slice(std::uint64_t first, bool state_known);
  void add(const TickRecord& record);
  // Declares that `number` records from sequence `first` on are missing here.
  void add_lost(std::uint64_t first, std::uint64_t number);
  // Hands everything added so far to the kernel: from then on it survives the death of this process.
  void flush();
  // Footer and fsync: from then on it survives a power cut.
  void finish();
  std::uint64_t records() const { return records_; }
  std::uint64_t lost() const { return lost_; }

 private:
  void write_chunk(std::uint32_t tag, std::uint32_t count, std::span<const std::byte> payload);
  void write_all(const void* data, std::size_t bytes);

  std::string path_;
  int fd_ = -1;
  std::vector<std::byte> pending_;
  std::uint32_t pending_records_ = 0;
  std::uint64_t records_ = 0;
  std::uint64_t lost_ = 0;
};

// Reads a recording from memory. The constructor throws RecordingError unless prefix, header and initial state are
// intact and of this build's layout.
class RecordingReader {
 public:
  explicit RecordingReader(std::span<const std::byte> bytes);

  const RecordingHeader& header() const { return header_; }
  const State& initial_state() const { return initial_state_; }
  // Sequence of the first record; 1 unless this is a slice of a longer run.
  std::uint64_t first_sequence() const { return first_sequence_; }
  // Whether the initial state is the one before the first record, so that a replay can start there.
  bool state_known() const { return state_known_; }
  // Next record in order; false at the end or at the first damage. A gap in record.sequence is a loss.
  bool next(TickRecord& record);
  // After next() returned false: empty if the recording is whole, otherwise what is wrong and where.
  const std::string& error() const { return error_; }
  // After next() returned false: the file ended before its footer, as while it is still being written. Then extend()
  // goes on with `bytes`, the same file grown longer, from the first record not read yet.
  bool cut() const { return cut_; }
  void extend(std::span<const std::byte> bytes);
  std::uint64_t records() const { return records_; }
  // Records declared lost so far.
  std::uint64_t lost() const { return lost_; }

 private:
  struct Chunk {
    std::uint32_t tag = 0;
    std::uint32_t count = 0;
    std::span<const std::byte> payload;
  };

  Chunk read_chunk();
  Chunk expect_chunk(std::uint32_t tag, std::size_t bytes);
  void read_prefix();
  void decode(TickRecord& record);
  void finish(const Chunk& chunk);
  void read_slice();

  std::span<const std::byte> bytes_;
  std::size_t offset_ = 0;        // of the next chunk
  std::size_t chunk_offset_ = 0;  // of the current one
  std::span<const std::byte> ticks_;
  std::uint32_t ticks_left_ = 0;
  RecordingHeader header_;
  State initial_state_;
  std::uint64_t records_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t first_sequence_ = 1;
  bool state_known_ = true;
  bool ended_ = false;
  bool cut_ = false;
  std::string error_;
};

// A file mapped read-only. Throws RecordingError when it cannot be opened or is empty.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::span<const std::byte> bytes() const { return {data_, size_}; }

 private:
  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace palpate
