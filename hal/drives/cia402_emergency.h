// What a drive's emergency message says, in words: error codes of CiA 301 (4.2.0, table 26) and of the drive profile
// (IEC 61800-7-201, table "error codes"), and the bits of the error register (object 1001h).
#pragma once

#include <cstdint>
#include <string>

namespace palpate::canopen {

// "0x4210 (device too hot; error register 0x09: generic, temperature)". A code that has no entry of its own is told by
// the class it is in: 0x2311 is one of 0x2310, that of 0x2300, that of 0x2000.
std::string emergency_text(std::uint32_t code, std::uint32_t error_register);

}  // namespace palpate::canopen
