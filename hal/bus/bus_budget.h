// Does the traffic of one period fit the bus? Worst-case frame times with worst-case bit stuffing (Davis, Burns, Bril &
// Lukkien 2007 for classic CAN; ISO 11898-1:2015 for CAN FD), one error with its retransmission, and a margin.
#pragma once

#include <string>
#include <vector>

namespace palpate {

// Bits of a classic data frame with `bytes` 0..8, interframe space included: 55 + 10 s (11-bit identifier) or
// 80 + 10 s (29-bit).
int classic_bits(int bytes, bool extended);
// Bits of a CAN FD frame sent at the nominal and at the data rate; `bytes` a legal FD length (0..8, 12, 16, 20, 24, 32,
// 48, 64).
int fd_nominal_bits(bool extended);
int fd_data_bits(int bytes, bool extended);
bool legal_fd_length(int bytes);

struct BusRate {
  double nominal_bit_per_s = 1e6;
  double data_bit_per_s = 5e6;  // CAN FD data phase
};
double classic_us(int bytes, bool extended, const BusRate& rate);
double fd_us(int bytes, bool extended, const BusRate& rate);

struct BusMessage {
  std::string name;
  int bytes = 0;
  bool fd = false;
  bool extended = false;
  int per_period = 1;
};

struct BusBudget {
  std::vector<BusMessage> messages;
  BusRate rate;
  double period_us = 1000;
  double margin = 0.10;  // part of the period kept free
  int errors = 1;        // error frames (31 bits) with a retransmission of the longest frame, per period
};

struct BusVerdict {
  bool fits = false;
  double used_us = 0;       // worst case, errors included
  double available_us = 0;  // (1 - margin) of the period
  std::string text;         // a table, and on refusal what to change
};

// Illegal rates, lengths or margins do not fit either; the text says which. CAN FD frames are charged 2 nominal bits
// more than the formula for the switch of rates and the transceiver's delay.
BusVerdict check_bus_budget(const BusBudget& budget);

// Traffic of `nodes` haptic nodes of this project in one period; `local`: their commands carry the local model (FD).
BusBudget haptic_node_budget(bool fd, int nodes = 1, bool local = false);

}  // namespace palpate
