// That a device of drives was moved by hand and found right (palpate device-test --move), for runs that ask for it:
// FILE.moved beside the profile FILE is a copy of the profile as it was then. A changed profile is not proved by it,
// changed wires are not noticed.
#pragma once

#include <string>

namespace palpate {

// "" or why it cannot be written.
std::string record_moved(const std::string& profile);
bool is_moved(const std::string& profile);
// What is missing and the command that mends it; "" where is_moved.
std::string text_if_unmoved(const std::string& device, const std::string& profile);

}  // namespace palpate
