#include "config/bake/certificate_writer.h"

#include <algorithm>
#include <cstring>

namespace palpate {

void append_certificate(std::vector<std::byte>& image, std::span<const CheckedPlace> place,
                        const TickCertificate* tick) {
  ImageHeader of_image;
  std::memcpy(&of_image, image.data(), sizeof of_image);
  image.resize(of_image.total_bytes);
  place = place.first(std::min(place.size(), std::size_t{kMaxCheckedPlaces}));
  if (place.empty() && tick == nullptr) return;
  const std::size_t ticks = tick != nullptr ? 1 : 0;
  std::vector<std::byte> body(place.size_bytes() + ticks * sizeof(TickCertificate));
  if (!place.empty()) std::memcpy(body.data(), place.data(), place.size_bytes());
  if (tick != nullptr) std::memcpy(body.data() + place.size_bytes(), tick, sizeof *tick);
  CertificateHeader header{};
  header.magic = kCertificateMagic;
  header.total_bytes = sizeof header + body.size();
  header.image_checksum = of_image.checksum;
  header.checksum = bytes_checksum(body);
  header.places = static_cast<std::int32_t>(place.size());
  header.ticks = static_cast<std::int32_t>(ticks);
  const auto* first = reinterpret_cast<const std::byte*>(&header);
  image.insert(image.end(), first, first + sizeof header);
  image.insert(image.end(), body.begin(), body.end());
}

}  // namespace palpate
