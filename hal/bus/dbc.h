// The wire protocol as a CAN database (.dbc) that candump post-processors, Wireshark and SavvyCAN read. Host side.
#pragma once

#include <string>

namespace palpate::wire {

// Text of docs/palpate.dbc for the given node number (1..15), generated from the codec's own table.
std::string dbc_text(int node = 1);

}  // namespace palpate::wire
