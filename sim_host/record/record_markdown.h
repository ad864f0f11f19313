// The tables of docs/record_format.md, from the table of fields itself.
#pragma once

#include <string>

namespace palpate {

std::string record_markdown();

}  // namespace palpate
