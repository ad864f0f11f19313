#include "hal/bus/bus_budget.h"

#include <algorithm>
#include <cstdio>

#include "hal/bus/codec.h"

namespace palpate {
namespace {

// Active error flag 6..12, delimiter 8, interframe space 3, suspend transmission 8 (Tindell & Burns 1994).
constexpr int kErrorFrameBits = 31;
constexpr int kFdExtraNominalBits = 2;

double message_us(const BusMessage& m, const BusRate& rate) {
  if (!m.fd) return classic_us(m.bytes, m.extended, rate);
  return fd_us(m.bytes, m.extended, rate) + 1e6 * kFdExtraNominalBits / rate.nominal_bit_per_s;
}

std::string problem_of(const BusBudget& b) {
  if (!(b.rate.nominal_bit_per_s >= 1e4 && b.rate.nominal_bit_per_s <= 1e6))
    return "nominal bit rate must be 10 kbit/s to 1 Mbit/s";
  if (!(b.rate.data_bit_per_s >= b.rate.nominal_bit_per_s && b.rate.data_bit_per_s <= 8e6))
    return "data bit rate must be between the nominal rate and 8 Mbit/s";
  if (!(b.period_us > 0) || !(b.margin >= 0 && b.margin < 1) || b.errors < 0)
    return "period must be positive, margin in [0, 1), errors >= 0";
  for (const BusMessage& m : b.messages) {
    if (m.fd ? !legal_fd_length(m.bytes) : (m.bytes < 0 || m.bytes > 8))
      return "message " + m.name + ": " + std::to_string(m.bytes) + " bytes is not a legal length";
    if (m.per_period < 1) return "message " + m.name + ": sent less than once per period";
  }
  return "";
}

std::string line(const char* name, int count, const std::string& what, double us) {
  char text[160];
  std::snprintf(text, sizeof text, "  %-22s %3d x %-14s %8.1f us\n", name, count, what.c_str(), us);
  return text;
}

}  // namespace

int classic_bits(int bytes, bool extended) {
  const int stuffable = (extended ? 54 : 34) + 8 * bytes;
  return stuffable + 13 + (stuffable - 1) / 4;
}

int fd_nominal_bits(bool extended) { return extended ? 57 : 34; }

int fd_data_bits(int bytes, bool extended) {
  return (extended ? 34 : 33) + 10 * bytes + (bytes > 16 ? 5 : 0);  // CRC-21 beyond 16 bytes
}

bool legal_fd_length(int bytes) {
  constexpr int kLong[] = {12, 16, 20, 24, 32, 48, 64};
  return (bytes >= 0 && bytes <= 8) || std::find(std::begin(kLong), std::end(kLong), bytes) != std::end(kLong);
}

double classic_us(int bytes, bool extended, const BusRate& rate) {
  return 1e6 * classic_bits(bytes, extended) / rate.nominal_bit_per_s;
}

double fd_us(int bytes, bool extended, const BusRate& rate) {
  return 1e6 * fd_nominal_bits(extended) / rate.nominal_bit_per_s +
         1e6 * fd_data_bits(bytes, extended) / rate.data_bit_per_s;
}

BusVerdict check_bus_budget(const BusBudget& budget) {
  BusVerdict verdict;
  const std::string problem = problem_of(budget);
  if (!problem.empty()) {
    verdict.text = "bus budget refused: " + problem + "\n";
    return verdict;
  }
  double longest_us = 0;
  for (const BusMessage& m : budget.messages) {
    const double us = message_us(m, budget.rate);
    longest_us = std::max(longest_us, us);
    verdict.used_us += us * m.per_period;
    verdict.text += line(m.name.c_str(), m.per_period, std::to_string(m.bytes) + (m.fd ? " B FD" : " B classic"),
                         us * m.per_period);
  }
  const double error_us = budget.errors * (1e6 * kErrorFrameBits / budget.rate.nominal_bit_per_s + longest_us);
  verdict.used_us += error_us;
  verdict.available_us = (1 - budget.margin) * budget.period_us;
  verdict.fits = verdict.used_us <= verdict.available_us;
  verdict.text += line("error and repeat", budget.errors, "worst frame", error_us);
  char text[240];
  std::snprintf(text, sizeof text, "  worst case %.1f us of %.1f us (%.0f us period less %.0f %% margin): %s\n",
                verdict.used_us, verdict.available_us, budget.period_us, 100 * budget.margin,
                verdict.fits ? "fits" : "REFUSED; use CAN FD, a higher bit rate, fewer nodes or a longer period");
  verdict.text += text;
  return verdict;
}

BusBudget haptic_node_budget(bool fd, int nodes, bool local) {
  BusBudget budget;
  const std::uint32_t other = local ? wire::kCommandId : wire::kLocalCommandId;  // one of the two is sent
  for (const wire::MessageInfo& m : wire::messages())
    if (m.fd == fd && m.base_id != other) budget.messages.push_back({m.name, m.bytes, m.fd, false, nodes});
  return budget;
}

}  // namespace palpate
