#include "sim_host/record/recording_writer.h"

#include <cstring>
#include <utility>

namespace palpate {

namespace {

std::span<const std::byte> bytes_of(const auto& value) {
  return {reinterpret_cast<const std::byte*>(&value), sizeof(value)};
}

}  // namespace

RecordingWriter::RecordingWriter(PartFile file, RecordingHeader header, std::span<const std::byte> initial_state,
                                 std::span<const PackedPiece> image)
    : file_(std::move(file)) {
  plr::Prefix prefix{plr::kMagic, plr::kVersion, 0};
  prefix.crc = plr::crc32(&prefix, offsetof(plr::Prefix, crc));
  header.initial_state_hash = plr::crc32(initial_state.data(), initial_state.size());
  try {
    file_.write(&prefix, sizeof(prefix));
    write_chunk(plr::kHead, 1, bytes_of(header));
    write_chunk(plr::kState, 1, initial_state);
    for (const PackedPiece& piece : image) write_chunk(plr::kImage, piece.unpacked_bytes, piece.bytes);
  } catch (const RecordingError&) {
    file_.discard();
    throw;
  }
}

RecordingWriter::~RecordingWriter() {
  if (finished_) return;
  try {
    flush();
  } catch (const RecordingError&) {  // what is in the file stays
  }
  if (records_ == 0) file_.discard();
}

void RecordingWriter::write_chunk(std::uint32_t tag, std::uint32_t count, std::span<const std::byte> payload) {
  plr::ChunkHeader header{tag, count, static_cast<std::uint32_t>(payload.size()), 0};
  header.crc = plr::crc32(payload.data(), payload.size(), plr::crc32(&header, offsetof(plr::ChunkHeader, crc)));
  // One write for both, so a process killed between two system calls leaves no half chunk.
  std::vector<std::byte> whole(sizeof(header) + payload.size());
  std::memcpy(whole.data(), &header, sizeof(header));
  if (!payload.empty()) std::memcpy(whole.data() + sizeof(header), payload.data(), payload.size());
  file_.write(whole.data(), whole.size());
}

void RecordingWriter::begin_slice(std::uint64_t first, bool state_known) {
  write_chunk(plr::kSlice, 1, bytes_of(plr::Slice{first, state_known ? 1u : 0u}));
}

void RecordingWriter::add(const TickRecord& record) {
  const std::int32_t regions = record.region_count < 0             ? 0
                               : record.region_count > kMaxRegions ? kMaxRegions
                                                                   : record.region_count;
  const std::size_t bytes = plr::kRecordPrefix + static_cast<std::size_t>(regions) * sizeof(RegionRecord);
  const std::size_t at = pending_.size();
  pending_.resize(at + bytes);
  std::memcpy(pending_.data() + at, &record, bytes);
  std::memcpy(pending_.data() + at + offsetof(TickRecord, region_count), &regions, sizeof(regions));
  pending_records_ += 1;
  records_ += 1;
  if (pending_records_ == plr::kRecordsPerChunk) flush();
}

void RecordingWriter::add_lost(std::uint64_t first, std::uint64_t number) {
  flush();
  lost_ += number;
  write_chunk(plr::kLost, 1, bytes_of(plr::Lost{first, number}));
}

void RecordingWriter::flush() {
  if (pending_records_ == 0) return;
  write_chunk(plr::kTick, pending_records_, pending_);
  pending_.clear();
  pending_records_ = 0;
}

void RecordingWriter::finish() {
  flush();
  write_chunk(plr::kEnd, 1, bytes_of(plr::End{records_, lost_}));
  file_.finish();
  finished_ = true;
}

}  // namespace palpate
