// The one line `palpate run` keeps rewriting.
#pragma once

#include <cstdint>
#include <string>

#include "rt_core/record.h"

namespace palpate {

class StatusLine {
 public:
  // One line, without a line break, about the newest record.
  std::string text(const TickRecord& newest);

 private:
  std::uint64_t last_sequence_ = 0;
  std::int64_t last_deadline_ns_ = 0;
  std::int64_t first_deadline_ns_ = 0;
  std::int32_t worst_wake_ns_ = 0;  // of the records seen here; the summary has the true one
};

}  // namespace palpate
