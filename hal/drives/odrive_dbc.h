// CANSimple as a CAN database (.dbc), for candump's logs, SavvyCAN and other tools. Host side.
#pragma once

#include <span>
#include <string>

namespace palpate::odrive {

// Of drives with these node numbers; docs/odrive.dbc has 1 to 3. Values of parameters are shown as 32 bits: what they
// mean is the endpoint's.
std::string dbc_text(std::span<const int> nodes);

}  // namespace palpate::odrive
