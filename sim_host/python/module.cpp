// palpate._core: what palpate/__init__.py wraps. Names, units and help are there.
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <csignal>

#include "sim_host/build_id.h"
#include "sim_host/python/py_scene.h"
#include "sim_host/python/py_telemetry.h"
#include "sim_host/python/record_arrays.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/replay.h"
#include "sim_host/run/run_session.h"
#include "sim_host/status_text.h"

namespace py = pybind11;

namespace palpate {

namespace {

py::dict header_of(const RecordingReader& recording) {
  const RecordingHeader& header = recording.header();
  py::dict all;
  all["scene"] = header.scene_name;
  all["scene_hash"] = header.scene_hash;
  all["period_s"] = 1e-9 * static_cast<double>(header.period_ns);
  all["build"] = header.build_id;
  all["image_path"] = header.image_path;
  all["first_sequence"] = recording.first_sequence();
  return all;
}

// (header, ticks, regions, lost, damage)
py::tuple read_recording(const std::string& path) {
  const MappedFile file(path);
  RecordingReader recording(file.bytes());
  RecordArrays arrays;
  {
    const py::gil_scoped_release others_may_run;
    TickRecord record;
    while (recording.next(record)) arrays.add(record);
  }
  const py::tuple rows = arrays.take();
  return py::make_tuple(header_of(recording), rows[0], rows[1], recording.lost(), recording.error());
}

// (identical, what differs, ticks, regions), as the replay computed them.
py::tuple replay_recording(const std::string& path, const std::string& image) {
  const MappedFile file(path);
  RecordingReader recording(file.bytes());
  RecordArrays arrays;
  ReplayResult result;
  {
    const py::gil_scoped_release others_may_run;
    const RecordedScene scene(recording, image);
    result = replay(recording, scene.model(), [&](const TickRecord& recorded, const TickRecord& replayed) {
      TickRecord row = replayed;
      row.sequence = recorded.sequence;
      row.timing = recorded.timing;
      arrays.add(row);
    });
  }
  py::dict said;
  said["identical"] = result.identical();
  said["ticks"] = result.ticks;
  said["lost"] = result.lost;
  said["damage"] = result.damage;
  if (result.differs) {
    said["tick"] = result.tick;
    said["stage"] = result.stage;
    said["field"] = result.field;
    said["recorded"] = result.recorded;
    said["replayed"] = result.replayed;
  }
  const py::tuple rows = arrays.take();
  return py::make_tuple(said, rows[0], rows[1]);
}

py::dict run(const std::string& scene, double duration_s, const std::string& record, const std::string& path,
             const std::string& programs, const std::function<bool()>& goes_on) {
  RunOptions options;
  options.scene = scene;
  options.device = "loopback";
  options.time = RunTime::kVirtual;
  options.duration_s = duration_s;
  options.record = record;
  options.path = path;
  options.program_folder = programs;
  options.quiet = true;
  if (goes_on) {
    options.companion.goes_on = [&] {
      const py::gil_scoped_acquire python;
      return goes_on();
    };
  }
  RunResult result;
  {
    const py::gil_scoped_release others_may_run;
    result = run_session(options);
  }
  py::dict said;
  said["ticks"] = result.summary.ticks;
  said["stale_ticks"] = result.summary.stale_ticks;
  said["device_force_max_N"] = result.summary.device_force_max_N;
  said["contact_force_max_N"] = result.summary.contact_force_max_N;
  said["penetration_max_m"] = result.summary.penetration_max_m;
  said["fault"] = result.summary.fault;
  said["faults"] = result.faulted() ? bit_names(fault_bit_texts(), result.summary.fault) : "";
  said["interrupted"] = result.interrupted;
  said["record"] = record;
  return said;
}

py::dict bits_of(std::span<const BitText> table) {
  py::dict all;
  for (const BitText& bit : table) all[bit.name] = py::make_tuple(1u << bit.bit, bit.meaning, bit.remedy);
  return all;
}

void add_scene(py::module_& m) {
  py::class_<PyScene, std::shared_ptr<PyScene>>(m, "Scene")
      .def(py::init<const std::string&, const std::vector<std::string>&, const std::vector<std::string>&>())
      .def("save", &PyScene::save)
      .def("params", &PyScene::params)
      .def("param_meanings", &PyScene::param_meanings)
      .def("vertices", &PyScene::vertices)
      .def("triangles", &PyScene::triangles)
      .def("demo_path", &PyScene::demo_path)
      .def("demo_hand_N_per_m", &PyScene::demo_hand_N_per_m)
      .def("press", &PyScene::press)
      .def_property_readonly("name", [](const PyScene& scene) { return scene.model().name; })
      .def_property_readonly("hash", [](const PyScene& scene) { return scene.model().scene_hash; })
      .def_property_readonly("period_s", [](const PyScene& scene) { return scene.model().params.period_s; });
  py::class_<PyController>(m, "Controller")
      .def(py::init<std::shared_ptr<PyScene>, bool>())
      .def("reset", &PyController::reset)
      .def("tick", &PyController::tick)
      .def("last", &PyController::last)
      .def("kept", &PyController::kept)
      .def("device_wrench", &PyController::device_wrench)
      .def("mode", &PyController::mode)
      .def("state_hash", &PyController::state_hash)
      .def("deformed_surface", &PyController::deformed_surface)
      .def("record_to", &PyController::record_to)
      .def("finish_recording", &PyController::finish_recording);
}

void add_telemetry(py::module_& m) {
  py::class_<PyTelemetry>(m, "Telemetry")
      .def(py::init<const std::string&>())
      .def("header", &PyTelemetry::header)
      .def("read", &PyTelemetry::read)
      .def("newest", &PyTelemetry::newest)
      .def_property_readonly("lost", &PyTelemetry::lost)
      .def_property_readonly("has_ended", &PyTelemetry::has_ended);
}

}  // namespace

}  // namespace palpate

PYBIND11_MODULE(_core, m) {
  using namespace palpate;
  m.attr("build_id") = kBuildId;
  m.attr("status_bits") = bits_of(status_bit_texts());
  m.attr("fault_bits") = bits_of(fault_bit_texts());
  m.attr("tick_dtype") = tick_dtype();
  m.attr("region_dtype") = region_dtype();
  m.attr("tick_fields") = tick_fields();
  m.attr("region_fields") = region_fields();
  m.def("read_recording", &read_recording);
  m.def("replay", &replay_recording);
  m.def("run", &run);
  add_scene(m);
  add_telemetry(m);
}
