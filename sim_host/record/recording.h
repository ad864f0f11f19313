// The recording file (.plr): what a replay needs to reproduce a run bit by bit, and what every tool that draws a run
// reads. Little-endian.
//
//   8 bytes magic "LPREC01\0", u32 version, u32 CRC-32 of those 12 bytes
//   chunks: u32 tag, u32 count, u32 payload bytes, u32 CRC-32 of the 12 bytes before and of the payload; payload
//     HEAD  one RecordingHeader        first
//     STAT  one State: initial state   second
//     IMAG  a piece of the scene image, a zlib stream, `count` bytes when unpacked; in order, next; may be absent
//     SLIC  {first sequence, 1 if STAT is the state before it}: only in a slice of a longer run, next
//     TICK  `count` records: TickRecord up to `region`, then region_count RegionRecords each
//     LOST  {first sequence, number}: records the recorder did not get
//     END   {records, lost}: the recording was finished properly; nothing follows
//
// Every byte lies under a checksum. A damaged or cut file is reported with the offset of the first bad chunk, and
// everything before it stays readable. While it is written the file is NAME.part, locked; finish() renames it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "rt_core/record.h"
#include "sim_host/rings/record_fields.h"
#include "sim_host/rings/telemetry.h"

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

constexpr FieldTable fields_of_recording_header() {
  FieldTable table;
  constexpr std::size_t base = 0;
  PALPATE_MEMBER(RecordingHeader, layout_hash, "of the record's and the state's layout: equal in builds that fit");
  PALPATE_MEMBER(RecordingHeader, scene_hash, "checksum of the image");
  PALPATE_MEMBER(RecordingHeader, initial_state_hash, "CRC-32 of the bytes of the initial state");
  PALPATE_MEMBER(RecordingHeader, period_ns, "of the loop");
  PALPATE_MEMBER(RecordingHeader, scene_name, "of the scene");
  PALPATE_MEMBER(RecordingHeader, build_id, "version, compiler and flags of the controller");
  PALPATE_MEMBER(RecordingHeader, image_path, "of the image, where it was read");
  return table;
}
inline constexpr FieldTable kRecordingHeaderFields = fields_of_recording_header();
static_assert(kRecordingHeaderFields.covers(sizeof(RecordingHeader)),
              "a member of RecordingHeader lacks its line here");

// The header of a run whose controller shares `telemetry`. The texts are terminated, whatever the region holds.
RecordingHeader recording_header(const TelemetryHeader& telemetry);
// Of the scene its newest records are of.
RecordingHeader recording_header(const TelemetryRegion& telemetry);

// The format, for writer and reader.
namespace plr {

inline constexpr std::uint64_t kMagic = 0x003130434552504Cull;  // bytes "LPREC01\0"
inline constexpr std::uint32_t kVersion = 5;
inline constexpr std::uint32_t kRecordsPerChunk = 256;
inline constexpr std::size_t kRecordPrefix = offsetof(TickRecord, region);
// Of the image, unpacked, in one chunk; packed it may be a little more.
inline constexpr std::uint32_t kImagePieceBytes = 256 * 1024;
inline constexpr std::size_t kMostChunkBytes = kRecordsPerChunk * sizeof(TickRecord);
static_assert(kImagePieceBytes + 1024 < kMostChunkBytes);

constexpr std::uint32_t tag_of(const char (&text)[5]) {
  std::uint32_t tag = 0;
  for (int i = 3; i >= 0; --i) tag = tag << 8 | static_cast<unsigned char>(text[i]);
  return tag;
}
inline constexpr std::uint32_t kHead = tag_of("HEAD"), kState = tag_of("STAT"), kImage = tag_of("IMAG"),
                               kSlice = tag_of("SLIC"), kTick = tag_of("TICK"), kLost = tag_of("LOST"),
                               kEnd = tag_of("END ");

struct Prefix {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t crc;
};
struct ChunkHeader {
  std::uint32_t tag, count, bytes, crc;
};
struct Slice {
  std::uint64_t first, state_known;
};
struct Lost {
  std::uint64_t first, number;
};
struct End {
  std::uint64_t records, lost;
};

// CRC-32 (IEEE 802.3, that of zlib), continued from `start`. Here because the controller, which writes its own black
// box, links no library.
std::uint32_t crc32(const void* data, std::size_t bytes, std::uint32_t start = 0);

}  // namespace plr

}  // namespace palpate
