// Structs whose fields are the rows of a table: members, hash, comparison and dump are made from it.
#pragma once

#include <cstdint>

#include "rt_core/state_visit.h"

namespace palpate {

// One row of a table: X(type, name, value after a reset, meaning).
#define PALPATE_STATE_FIELD(type, name, initial, meaning) type name = initial;
#define PALPATE_STATE_VISIT(type, name, initial, meaning) visit_value(visitor, #name, name);
#define PALPATE_STATE_LAYOUT(type, name, initial, meaning) hash = layout_with<type>(hash, #name);
// The members of a table's fields, and visit(): the visitor gets every value in the table's order, with its name.
#define PALPATE_STATE_FIELDS_OF(FIELDS)                                  \
  FIELDS(PALPATE_STATE_FIELD)                                            \
  template <class Visitor>                                               \
  void visit(Visitor& visitor) const PALPATE_RT_IF(Visitor::kRealTime) { \
    FIELDS(PALPATE_STATE_VISIT)                                          \
  }                                                                      \
  static constexpr std::uint64_t layout(std::uint64_t hash) noexcept {   \
    FIELDS(PALPATE_STATE_LAYOUT)                                         \
    return hash;                                                         \
  }

}  // namespace palpate
