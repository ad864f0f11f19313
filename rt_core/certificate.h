// What may follow an image in its file: what is known of how well the scene does. No tick reads it, and it is no part
// of the image that recordings name: a scene can be certified after it was run. It belongs to one image alone.
#pragma once

#include "rt_core/image.h"

namespace palpate {

inline constexpr std::uint64_t kCertificateMagic = 0x0031545245434C50ull;  // bytes "PLCERT1\0"
// As many presses as body.elastic.check_presses allows.
inline constexpr std::int32_t kMaxCheckedPlaces = 16;

// A place where a ball was pressed into the baked body by ticks and into large-strain elements (config/bake).
struct CheckedPlace {
  Vec3 place_m;        // world
  double radius_m;     // of the ball
  double depth_m;      // deepest
  double reference_N;  // there, by the elements
  double force_N;      // there, of the baked body
  double worst_error;  // relative, of the force, on the way there
};
// What a search for dear ticks found (sim_host/certify), by the work that ticks count of themselves.
struct TickCertificate {
  double stage_instructions[kStageCount];          // the dearest of each stage
  double tick_instructions;                        // the dearest tick
  double ticks;                                    // looked at
  double image_bytes, state_bytes, scratch_bytes;  // in the pages that the dearest tick touches
};

struct CertificateHeader {
  std::uint64_t magic;
  std::uint64_t total_bytes;     // of the certificate
  std::uint64_t image_checksum;  // of the image it belongs to
  std::uint64_t checksum;        // of all bytes after this header
  std::int32_t places;           // CheckedPlace that follow
  std::int32_t ticks;            // TickCertificate that follow: 0 or 1
};
static_assert(sizeof(CertificateHeader) == 40 && sizeof(CheckedPlace) == 64 && sizeof(TickCertificate) == 96);

struct Certificate {
  std::span<const CheckedPlace> place;
  const TickCertificate* tick = nullptr;
};

// Of the bytes behind an image with that checksum; none is a certificate of nothing.
ImageResult open_certificate(std::span<const std::byte> bytes, std::uint64_t image_checksum,
                             Certificate& certificate) noexcept;
// Of a whole file that open_image() has accepted.
Certificate certificate_of(std::span<const std::byte> file) noexcept;

}  // namespace palpate
