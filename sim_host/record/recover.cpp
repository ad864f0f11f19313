#include "sim_host/record/recover.h"

#include <cstring>
#include <filesystem>
#include <vector>

#include "hal/system/file_lock.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/recording_writer.h"

namespace palpate {

namespace {

constexpr char kRecoveringSuffix[] = ".recovering";

// The end of what was copied so far.
struct Tail {
  std::uint64_t expected = 1;  // sequence of the next record
  std::uint64_t state_hash = 0;
  std::int64_t deadline_ns = 0;
};

// Adds what `reader` still holds from the tail on, gaps declared.
std::uint64_t copy_records(RecordingReader& reader, RecordingWriter& writer, Tail& tail) {
  TickRecord record;
  std::uint64_t number = 0;
  while (reader.next(record)) {  // bound: records of the file
    if (record.sequence < tail.expected) continue;
    if (record.sequence > tail.expected) writer.add_lost(tail.expected, record.sequence - tail.expected);
    writer.add(record);
    tail = {record.sequence + 1, record.state_hash, record.timing.deadline_ns};
    number += 1;
  }
  return number;
}

// Whether the controller's file goes on where the tail ends: the same scene and build, and the tail's own record in it.
bool continues(const std::span<const std::byte> bytes, const RecordingHeader& header, const Tail& tail) {
  RecordingReader crash(bytes);
  if (crash.header().scene_hash != header.scene_hash) return false;
  if (std::strcmp(crash.header().build_id, header.build_id) != 0) return false;
  if (tail.expected == 1) return crash.first_sequence() == 1;
  TickRecord record;
  while (crash.next(record)) {  // bound: records of the file
    if (record.sequence + 1 != tail.expected) continue;
    return record.state_hash == tail.state_hash && record.timing.deadline_ns == tail.deadline_ns;
  }
  return false;
}

std::uint64_t add_crash(const std::string& path, const RecordingHeader& header, RecordingWriter& writer, Tail& tail) {
  if (!std::filesystem::exists(path)) return 0;
  const MappedFile file(path);
  if (!continues(file.bytes(), header, tail)) return 0;
  RecordingReader crash(file.bytes());
  return copy_records(crash, writer, tail);
}

std::vector<PackedPiece> image_of(const RecordingReader& reader) {
  std::vector<PackedPiece> image;
  for (const RecordingReader::ImagePiece& piece : reader.image()) {
    image.push_back({piece.unpacked_bytes, {piece.packed.begin(), piece.packed.end()}});
  }
  return image;
}

// The name a .part file was to get.
std::string final_name(const std::string& part) {
  const std::string suffix = kPartSuffix;
  return part.ends_with(suffix) ? part.substr(0, part.size() - suffix.size()) : "";
}

}  // namespace

std::string crash_path(const std::string& recording) {
  return std::filesystem::path(recording).replace_extension().string() + ".crash.plr";
}

Recovered recover_recording(const std::string& part, const std::string& output) {
  Recovered result;
  result.path = output.empty() ? final_name(part) : output;
  if (result.path.empty()) throw RecordingError(part + ": does not end in .part; name the recording to make with -o");
  const MappedFile file(part);
  if (!lock_exclusively(file.fd())) throw RecordingError(part + ": " + lock_holder(file.fd()) + " is still writing it");
  RecordingReader reader(file.bytes());
  // Left by a recovery that was killed: this one holds the lock.
  std::filesystem::remove(result.path + kRecoveringSuffix);
  RecordingWriter writer(PartFile(result.path, WhenItExists::kRefuse, kRecoveringSuffix), reader.header(),
                         reader.stored_state(), image_of(reader));
  Tail tail{reader.first_sequence()};
  if (reader.first_sequence() != 1 || !reader.state_known()) writer.begin_slice(tail.expected, reader.state_known());
  copy_records(reader, writer, tail);
  result.damage = reader.error();
  const std::string crash = crash_path(final_name(part));
  result.from_crash = add_crash(crash, reader.header(), writer, tail);
  if (result.from_crash > 0) result.crash_path = crash;
  result.records = writer.records();
  result.lost = writer.lost();
  if (result.records == 0) throw RecordingError(part + ": not one complete tick is in it");
  writer.finish();
  std::filesystem::remove(part);
  return result;
}

}  // namespace palpate
