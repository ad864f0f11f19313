#include "sim_host/run/status_line.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim_host/status_text.h"

namespace palpate {

std::string StatusLine::text(const TickRecord& newest) {
  const std::int64_t now_ns = newest.timing.deadline_ns;
  if (first_deadline_ns_ == 0) first_deadline_ns_ = now_ns;
  const double span_s = 1e-9 * static_cast<double>(now_ns - last_deadline_ns_);
  const double rate =
      last_sequence_ > 0 && span_s > 0 ? static_cast<double>(newest.sequence - last_sequence_) / span_s : 0;
  last_sequence_ = newest.sequence;
  last_deadline_ns_ = now_ns;
  worst_wake_ns_ = std::max(worst_wake_ns_, newest.timing.wake_latency_ns);
  const Output& output = newest.output;
  return fmt::format(
      "{:7.2f} s  {:6.1f} Hz  {:7.3f} N  {} regions  {:7.3f} mm  {:<7}  worst wake-up {:6.1f} us  {}",
      1e-9 * static_cast<double>(now_ns - first_deadline_ns_), rate, norm(output.device_w.force_N), output.regions,
      1e3 * output.penetration_m, mode_name(output.mode), 1e-3 * static_cast<double>(worst_wake_ns_),
      output.fault != 0 ? bit_names(fault_bit_texts(), output.fault) : bit_names(status_bit_texts(), output.status));
}

}  // namespace palpate
