// What an action is refused with.
#pragma once

#include <string>

#include "config/scene/config_error.h"

namespace palpate::test {

// The error's text, or "accepted". Errors of another type go on to the test.
template <class Error = ConfigError, class Action>
std::string refusal_by(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace palpate::test
