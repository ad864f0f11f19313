// Checks of option values that CLI11 does not bring, with messages a person can act on.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hal/system/duration.h"

namespace palpate {

// A file name with one of these endings: the ending decides what is written.
inline CLI::Validator ends_in(std::vector<std::string> endings) {
  return CLI::Validator(
      [endings = std::move(endings)](const std::string& name) {
        std::string known;
        for (const std::string& ending : endings) {
          if (name.ends_with(ending)) return std::string();
          known += (known.empty() ? "" : " or ") + ending;
        }
        return name + ": the name must end in " + known;
      },
      "");
}

// CLI::Range lets a NaN through, which is not below its limits either.
inline CLI::Validator number_in(double lowest, double highest) {
  return CLI::Validator(
      [lowest, highest](const std::string& text) {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && value >= lowest && value <= highest) return std::string();
        return text + " is not a number from " + CLI::detail::to_string(lowest) + " to " +
               CLI::detail::to_string(highest);
      },
      "");
}

// For transform(): seconds, or 10s, 5m, 1h, 1h30m; the option gets seconds.
inline CLI::Validator duration_in(double lowest_s, double highest_s) {
  return CLI::Validator(
      [lowest_s, highest_s](std::string& text) {
        const std::optional<double> seconds = seconds_of(text);
        if (!seconds) return text + " is no duration such as 10s, 5m or 1h";
        if (!(*seconds >= lowest_s && *seconds <= highest_s))
          return text + " is not a duration from " + CLI::detail::to_string(lowest_s) + " s to " +
                 CLI::detail::to_string(highest_s) + " s";
        text = CLI::detail::to_string(*seconds);
        return std::string();
      },
      "");
}

// CLI::PositiveNumber names the largest double as the upper limit.
inline CLI::Validator above_zero() {
  return CLI::Validator(
      [](const std::string& text) {
        double value = 0;
        return CLI::detail::lexical_cast(text, value) && value > 0 ? std::string() : text + " is not a number above 0";
      },
      "");
}

}  // namespace palpate
