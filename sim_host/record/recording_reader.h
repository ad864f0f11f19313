#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim_host/record/recording.h"
#include "sim_host/tick_memory.h"

namespace palpate {

// Reads a recording from memory. The constructor throws RecordingError unless prefix, header and initial state are
// intact and of this build's layout.
class RecordingReader {
 public:
  explicit RecordingReader(std::span<const std::byte> bytes);

  const RecordingHeader& header() const { return header_; }
  // Throws RecordingError, naming the field, unless it is one that a tick of `model` may be given.
  StatePtr initial_state(const Model& model) const;
  // Its block unchecked: to be copied, not to be ticked.
  std::span<const std::byte> stored_state() const { return initial_state_; }
  // The scene image inside, packed; empty without one, and incomplete when the file is cut there.
  struct ImagePiece {
    std::uint32_t unpacked_bytes = 0;
    std::span<const std::byte> packed;
  };
  std::span<const ImagePiece> image() const { return image_; }
  // Sequence of the first record; 1 unless this is a slice of a longer run.
  std::uint64_t first_sequence() const { return first_sequence_; }
  // Whether the initial state is the one before the first record, so that a replay can start there.
  bool state_known() const { return state_known_; }
  // Next record in order; false at the end or at the first damage. A gap in record.sequence is a loss.
  bool next(TickRecord& record);
  // After next() returned false: empty if the recording is whole, otherwise what is wrong and where.
  const std::string& error() const { return error_; }
  // After next() returned false: the file ended before its footer, as while it is still being written. Then extend()
  // goes on with `bytes`, the same file grown longer (never shorter), from the first record not read yet.
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
  std::uint32_t next_tag() const;
  void read_image();
  void read_slice();

  std::span<const std::byte> bytes_;
  std::size_t offset_ = 0;        // of the next chunk
  std::size_t chunk_offset_ = 0;  // of the current one
  std::span<const std::byte> ticks_;
  std::uint32_t ticks_left_ = 0;
  RecordingHeader header_;
  std::vector<std::byte> initial_state_;
  std::vector<ImagePiece> image_;
  std::uint64_t records_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t first_sequence_ = 1;
  bool state_known_ = true;
  bool ended_ = false;
  bool cut_ = false;
  std::string error_;
};

}  // namespace palpate
