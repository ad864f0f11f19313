// The telemetry of a controller that runs, as Python sees it.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "sim_host/rings/telemetry_door.h"

namespace palpate {

class PyTelemetry {
 public:
  // `where`: the path of a door, or the process id of a palpate-rt. Throws std::runtime_error with what to do.
  explicit PyTelemetry(const std::string& where);
  pybind11::dict header() const;
  // (ticks, regions) of at most `most` records that were not read yet, oldest first.
  pybind11::tuple read(std::size_t most);
  // (ticks, regions) of the newest record; none before the first one.
  pybind11::tuple newest() const;
  // Records that were overwritten before read() came to them.
  std::uint64_t lost() const { return reader_.lost(); }
  bool has_ended() const;

 private:
  AttachedTelemetry telemetry_;
  TelemetryReader reader_;
};

}  // namespace palpate
