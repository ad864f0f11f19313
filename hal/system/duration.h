// Durations as people write them: "10", "10s", "5m", "1h", "1h30m".
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace palpate {

// Seconds of "1h", "10m", "30s", "1h30m", "2.5m"; nothing for anything else, zero, or more than 31 days.
inline std::optional<double> parse_duration_s(std::string_view text) {
  double total_s = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    double value = 0;
    const auto [after, status] = std::from_chars(at, end, value, std::chars_format::fixed);
    if (status != std::errc{} || after == end || !(value >= 0)) return std::nullopt;
    const double unit_s = *after == 'h' ? 3600 : *after == 'm' ? 60 : *after == 's' ? 1 : 0;
    if (unit_s == 0) return std::nullopt;
    total_s += value * unit_s;
    at = after + 1;
  }
  if (!(total_s > 0) || total_s > 31 * 86400.0) return std::nullopt;
  return total_s;
}

// The same, and a bare number as seconds.
inline std::optional<double> seconds_of(std::string_view text) {
  if (const std::optional<double> told = parse_duration_s(text)) return told;
  double value = 0;
  const auto [after, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc{} || after != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace palpate
