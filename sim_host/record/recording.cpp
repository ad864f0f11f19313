#include "sim_host/record/recording.h"

#include <array>
#include <cstring>

namespace palpate {

namespace {

template <std::size_t N>
void copy_text(char (&to)[N], const char (&from)[N]) {
  std::memcpy(to, from, N);
  to[N - 1] = '\0';
}

// table[k][b]: what byte b does to the remainder when k more bytes follow it, so that eight bytes take one step.
constexpr auto kTable = [] {
  std::array<std::array<std::uint32_t, 256>, 8> table{};
  for (std::uint32_t b = 0; b < 256; ++b) {
    std::uint32_t remainder = b;
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder >> 1) ^ ((remainder & 1) != 0 ? 0xEDB88320u : 0);
    table[0][b] = remainder;
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::size_t b = 0; b < 256; ++b) table[k][b] = (table[k - 1][b] >> 8) ^ table[0][table[k - 1][b] & 0xff];
  return table;
}();

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

RecordingHeader recording_header(const TelemetryRegion& telemetry) {
  RecordingHeader header = recording_header(telemetry.header);
  if (const TelemetryScene* scene = newest_scene(telemetry)) {
    header.scene_hash = scene->scene_hash;
    copy_text(header.scene_name, scene->scene_name);
    copy_text(header.image_path, scene->image_path);
  }
  return header;
}

std::uint32_t plr::crc32(const void* data, std::size_t bytes, std::uint32_t start) {
  const auto* at = static_cast<const unsigned char*>(data);
  std::uint32_t crc = ~start;
  for (; bytes >= 8; bytes -= 8, at += 8) {
    std::uint64_t word;
    std::memcpy(&word, at, 8);
    word ^= crc;
    crc = 0;
    for (std::size_t k = 0; k < 8; ++k) crc ^= kTable[7 - k][(word >> (8 * k)) & 0xff];
  }
  for (; bytes > 0; --bytes, ++at) crc = (crc >> 8) ^ kTable[0][(crc ^ *at) & 0xff];
  return ~crc;
}

}  // namespace palpate
