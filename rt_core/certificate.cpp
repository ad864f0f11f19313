#include "rt_core/certificate.h"

#include <cstring>

#include "rt_core/math.h"

namespace palpate {

namespace {

bool is_size(double x) noexcept { return x >= 0 && x < kHuge; }

bool is_sound(const CheckedPlace& c) noexcept {
  return is_finite(c.place_m) && is_size(c.radius_m) && is_size(c.depth_m) && is_size(c.reference_N) &&
         is_size(c.worst_error) && abs_of(c.force_N) < kHuge;
}

bool is_sound(const TickCertificate& c) noexcept {
  for (const double found : c.stage_instructions)
    if (!is_size(found)) return false;
  return is_size(c.tick_instructions) && is_size(c.ticks) && is_size(c.image_bytes) && is_size(c.state_bytes) &&
         is_size(c.scratch_bytes);
}

}  // namespace

ImageResult open_certificate(std::span<const std::byte> bytes, std::uint64_t image_checksum,
                             Certificate& certificate) noexcept {
  certificate = {};
  if (bytes.empty()) return {};
  CertificateHeader header;
  if (bytes.size() < sizeof header) return {ImageError::kTotalSize, "total_bytes"};
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != kCertificateMagic) return {ImageError::kTotalSize, "total_bytes"};
  if (header.image_checksum != image_checksum) return {ImageError::kCombination, "certificate.image_checksum"};
  if (!(header.places >= 0 && header.places <= kMaxCheckedPlaces && (header.ticks == 0 || header.ticks == 1)))
    return {ImageError::kSizeRange, "certificate"};
  const auto places = static_cast<std::size_t>(header.places), ticks = static_cast<std::size_t>(header.ticks);
  const std::size_t total = sizeof header + places * sizeof(CheckedPlace) + ticks * sizeof(TickCertificate);
  if (header.total_bytes != total || total != bytes.size()) return {ImageError::kTotalSize, "certificate.total_bytes"};
  if (header.checksum != bytes_checksum(bytes.subspan(sizeof header)))
    return {ImageError::kChecksum, "certificate.checksum"};
  const std::byte* at = bytes.data() + sizeof header;
  certificate.place = {reinterpret_cast<const CheckedPlace*>(at), places};
  if (ticks > 0) certificate.tick = reinterpret_cast<const TickCertificate*>(at + places * sizeof(CheckedPlace));
  for (std::size_t i = 0; i < places; ++i)
    if (!is_sound(certificate.place[i]))
      return {ImageError::kNotFinite, "certificate.place", static_cast<std::int64_t>(i)};
  if (certificate.tick != nullptr && !is_sound(*certificate.tick)) return {ImageError::kNotFinite, "certificate.tick"};
  return {};
}

Certificate certificate_of(std::span<const std::byte> file) noexcept {
  ImageHeader header;
  std::memcpy(&header, file.data(), sizeof header);
  Certificate certificate;
  if (header.total_bytes > file.size()) return certificate;
  const ImageResult result = open_certificate(file.subspan(header.total_bytes), header.checksum, certificate);
  return result.error == ImageError::kNone ? certificate : Certificate{};
}

}  // namespace palpate
