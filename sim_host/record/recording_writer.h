// Writes a recording (sim_host/record/recording.h). Every function throws RecordingError when the file system refuses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim_host/record/part_file.h"
#include "sim_host/record/recording.h"
#include "sim_host/tick_memory.h"

namespace palpate {

// A piece of the scene image, packed (sim_host/record/recorded_image.h).
struct PackedPiece {
  std::uint32_t unpacked_bytes = 0;
  std::vector<std::byte> bytes;
};

class RecordingWriter {
 public:
  // `initial_state`: the block of the State before the first record. `image`: the scene's, so that the recording can be
  // replayed without it; may be empty.
  RecordingWriter(PartFile file, RecordingHeader header, std::span<const std::byte> initial_state,
                  std::span<const PackedPiece> image = {});
  // The same, under a name that must be free.
  RecordingWriter(const std::string& path, const RecordingHeader& header, const State& initial_state)
      : RecordingWriter(PartFile(path, WhenItExists::kRefuse), header, block_of(initial_state)) {}
  // Without finish(): what was written stays, as NAME.part; nothing stays when not one record was added.
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
  // Footer, fsync, and the name: from then on it survives a power cut.
  void finish();
  std::uint64_t records() const { return records_; }
  std::uint64_t lost() const { return lost_; }
  // Where it is until finish(), and after it.
  std::string part_path() const { return file_.part_path(); }
  const std::string& path() const { return file_.path(); }

 private:
  void write_chunk(std::uint32_t tag, std::uint32_t count, std::span<const std::byte> payload);

  PartFile file_;
  std::vector<std::byte> pending_;
  std::uint32_t pending_records_ = 0;
  std::uint64_t records_ = 0;
  std::uint64_t lost_ = 0;
  bool finished_ = false;
};

}  // namespace palpate
