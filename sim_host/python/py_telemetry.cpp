#include "sim_host/python/py_telemetry.h"

#include <filesystem>

#include "sim_host/python/record_arrays.h"

namespace py = pybind11;

namespace palpate {

namespace {

// A text of the region, whose end the writer may have forgotten.
template <std::size_t N>
std::string text_of(const char (&text)[N]) {
  return {text, strnlen(text, N)};
}

}  // namespace

PyTelemetry::PyTelemetry(const std::string& where)
    : telemetry_(attach_telemetry(where)), reader_(telemetry_.region()) {}

py::dict PyTelemetry::header() const {
  const TelemetryHeader& header = telemetry_.region().header;
  const TelemetryScene* later = newest_scene(telemetry_.region());
  py::dict all;
  all["scene"] = later != nullptr ? text_of(later->scene_name) : text_of(header.scene_name);
  all["scene_hash"] = later != nullptr ? later->scene_hash : header.scene_hash;
  all["image_path"] = later != nullptr ? text_of(later->image_path) : text_of(header.image_path);
  all["period_s"] = 1e-9 * static_cast<double>(header.period_ns);
  all["build"] = text_of(header.build_id);
  all["controller"] = telemetry_.controller;
  return all;
}

py::tuple PyTelemetry::read(std::size_t most) {
  RecordArrays arrays;
  {
    const py::gil_scoped_release others_may_run;
    TickRecord record;
    while (arrays.size() < most && reader_.next(record)) arrays.add(record);
  }
  return arrays.take();
}

py::tuple PyTelemetry::newest() const {
  RecordArrays arrays;
  TickRecord record;
  if (reader_.newest(record)) arrays.add(record);
  return arrays.take();
}

bool PyTelemetry::has_ended() const {
  return !std::filesystem::exists("/proc/" + std::to_string(telemetry_.controller));
}

}  // namespace palpate
