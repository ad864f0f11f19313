#include "sim_host/bake/certificate_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/certificate.h"

namespace palpate {

namespace {

std::string force_text(std::span<const CheckedPlace> places) {
  if (places.empty())
    return "force   not certified: no press was held against finite elements (error_target, or "
           "body.elastic.check_presses)\n";
  const auto [shallow, deep] = std::ranges::minmax(places, {}, &CheckedPlace::depth_m);
  const CheckedPlace& worst = *std::ranges::max_element(places, {}, &CheckedPlace::worst_error);
  return fmt::format(
      "force   error at most {:.1f} % of large-strain elements: a ball of {:.4g} mm at {} places, {:.3g} to {:.3g} mm "
      "deep;\n        worst at ({:.4g}, {:.4g}, {:.4g}) mm, {:.4g} N by elements, {:.4g} N baked at {:.3g} mm\n",
      100 * worst.worst_error, 1e3 * worst.radius_m, places.size(), 1e3 * shallow.depth_m, 1e3 * deep.depth_m,
      1e3 * worst.place_m.x, 1e3 * worst.place_m.y, 1e3 * worst.place_m.z, worst.reference_N, worst.force_N,
      1e3 * worst.depth_m);
}

std::string tick_text(const TickCertificate* tick) {
  if (tick == nullptr) return "tick    not certified: `palpate certify` looks for the dearest\n";
  return fmt::format(
      "tick    dearest {:.0f} instructions in {:.0f} ticks of a search; touches {:.0f} KiB of the image, {:.0f} of "
      "State, {:.0f} of Scratch\n",
      tick->tick_instructions, tick->ticks, tick->image_bytes / 1024, tick->state_bytes / 1024,
      tick->scratch_bytes / 1024);
}

}  // namespace

bool is_certified(std::span<const std::byte> file) {
  const Certificate certificate = certificate_of(file);
  return !certificate.place.empty() || certificate.tick != nullptr;
}

std::string certificate_text(std::span<const std::byte> file) {
  const Certificate certificate = certificate_of(file);
  return force_text(certificate.place) + tick_text(certificate.tick);
}

Json tick_json(const TickCertificate& tick) {
  return {{"dearest_instructions", tick.tick_instructions},
          {"ticks", tick.ticks},
          {"touched_image_bytes", tick.image_bytes},
          {"touched_state_bytes", tick.state_bytes},
          {"touched_scratch_bytes", tick.scratch_bytes}};
}

Json certificate_json(std::span<const std::byte> file) {
  const Certificate certificate = certificate_of(file);
  Json json = {{"force", nullptr}, {"tick", nullptr}};
  for (const CheckedPlace& place : certificate.place)
    json["force"].push_back({{"place_m", {place.place_m.x, place.place_m.y, place.place_m.z}},
                             {"radius_m", place.radius_m},
                             {"depth_m", place.depth_m},
                             {"reference_N", place.reference_N},
                             {"force_N", place.force_N},
                             {"worst_error", place.worst_error}});
  if (certificate.tick != nullptr) json["tick"] = tick_json(*certificate.tick);
  return json;
}

}  // namespace palpate
