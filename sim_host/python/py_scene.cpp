#include "sim_host/python/py_scene.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "rt_core/tick.h"
#include "sim_host/build_id.h"
#include "sim_host/press/press.h"
#include "sim_host/python/record_arrays.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/view/deformed_surface.h"

namespace palpate {

namespace py = pybind11;

namespace {

Pose pose_of(const double* row) { return {{row[0], row[1], row[2]}, {row[3], row[4], row[5], row[6]}}; }

std::vector<TimedPose> poses_of(const DoubleArray& poses, const DoubleArray& closing, double period_s) {
  std::vector<TimedPose> list(static_cast<std::size_t>(poses.shape(0)));
  for (std::size_t i = 0; i < list.size(); ++i) {
    list[i].time_s = static_cast<double>(i) * period_s;
    list[i].tool_w = pose_of(poses.data(static_cast<py::ssize_t>(i)));
    if (closing.size() == 0) continue;
    for (float& finger : list[i].joints.closing) finger = static_cast<float>(closing.at(i));
  }
  return list;
}

}  // namespace

PyScene::PyScene(const std::string& path, const std::vector<std::string>& overlay,
                 const std::vector<std::string>& setting) {
  const py::gil_scoped_release others_may_run;
  scene_ = std::make_unique<SceneModel>(path, SceneOverlays{overlay, setting});
}

void PyScene::save(const std::string& path) const {
  PartFile file(path, WhenItExists::kReplace);
  file.write(bytes().data(), bytes().size());
  file.finish();
}

py::dict PyScene::params() const {
  py::dict all;
  const auto put = [&]<class T>(const char* name, T value) {
    if constexpr (std::is_enum_v<T>) {
      all[name] = ChoiceOf<T>::kWord[static_cast<std::size_t>(value)];
    } else {
      all[name] = value;
    }
  };
#define PALPATE_FIELD(type, name, unit, lowest, highest, meaning) put(#name, model().params.name);
  PALPATE_MODEL_PARAMS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return all;
}

py::dict PyScene::param_meanings() const {
  py::dict all;
#define PALPATE_FIELD(type, name, unit, lowest, highest, meaning) all[#name] = py::make_tuple(unit, meaning);
  PALPATE_MODEL_PARAMS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return all;
}

py::array PyScene::vertices() const {
  const auto vertices = model().vertex_m;
  return py::array_t<double>({vertices.size(), std::size_t{3}}, &vertices.data()->x);
}

py::array PyScene::triangles() const {
  py::array_t<std::int32_t> corners({model().triangle.size(), std::size_t{3}});
  for (std::size_t i = 0; i < model().triangle.size(); ++i)
    std::memcpy(corners.mutable_data(i, 0), model().triangle[i].vertex, sizeof(std::int32_t) * 3);
  return corners;
}

const SceneDesc& PyScene::description(const char* wanted) const {
  if (!scene_->scene())
    throw std::runtime_error(std::string("an image holds no ") + wanted + "; name the scene's .toml");
  return *scene_->scene();
}

py::array PyScene::demo_path() const {
  const std::vector<TimedPose> poses = scripted_poses(description("path").path, model().params.period_s);
  py::array_t<double> rows({poses.size(), std::size_t{8}});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Vec3 p = poses[i].tool_w.position_m;
    const Quat q = poses[i].tool_w.orientation;
    const double row[8] = {poses[i].time_s, p.x, p.y, p.z, q.w, q.x, q.y, q.z};
    std::memcpy(rows.mutable_data(i, 0), row, sizeof row);
  }
  return rows;
}

double PyScene::demo_hand_N_per_m() const { return description("hand").path.hand_stiffness_N_per_m; }

py::tuple PyScene::press(const DoubleArray& poses, const DoubleArray& closing, double hand_N_per_m) const {
  const double period_s = model().params.period_s;
  const std::vector<TimedPose> list =
      poses.size() == 0 ? scripted_poses(description("path").path, period_s) : poses_of(poses, closing, period_s);
  RecordArrays arrays;
  {
    const py::gil_scoped_release others_may_run;
    arrays.reserve(list.size());
    const StatePtr state = make_state(model());
    palpate::press(model(), list, {hand_N_per_m}, *state, nullptr,
                   [&](const PressRow& row, const State&, const Scratch&) { arrays.add(row.record); });
  }
  return arrays.take();
}

PyController::PyController(std::shared_ptr<PyScene> scene, bool keep)
    : scene_(std::move(scene)),
      state_(make_state(scene_->model())),
      scratch_(make_scratch(scene_->model())),
      keep_(keep) {}

void PyController::reset() {
  if (writer_) throw std::runtime_error("a recording is being written: finish it before a reset");
  palpate::reset(*state_);
  record_ = {};
}

void PyController::tick(const std::array<double, 7>& pose, int drive, unsigned stale, unsigned commands,
                        unsigned device_fault, unsigned buttons, const std::array<float, kMaxFingers>& closing) {
  Input input;
  input.pose_w = pose_of(pose.data());
  input.drive = static_cast<Drive>(drive);
  input.stale_ticks = stale;
  input.commands = commands;
  input.device_fault = device_fault;
  input.buttons = buttons;
  std::memcpy(input.joints.closing, closing.data(), sizeof input.joints.closing);
  Output output;
  palpate::tick(scene_->model(), *state_, *scratch_, input, output);
  record_.sequence += 1;
  record_.timing = {};
  const double period_ns = 1e9 * scene_->model().params.period_s;
  record_.timing.deadline_ns = std::llround(period_ns * static_cast<double>(record_.sequence));
  fill_record(*state_, input, output, record_);
  if (keep_) kept_.add(record_);
  if (writer_) writer_->add(record_);
}

py::tuple PyController::last() const {
  RecordArrays arrays;
  if (record_.sequence > 0) arrays.add(record_);
  return arrays.take();
}

std::array<double, 6> PyController::device_wrench() const {
  const auto& [f, t] = record_.output.device_w;
  return {f.x, f.y, f.z, t.x, t.y, t.z};
}

std::uint64_t PyController::state_hash() const { return hash_state(*state_); }

py::array PyController::deformed_surface() const {
  const DeformedSurface surface = palpate::deformed_surface(scene_->model(), *state_);
  return py::array_t<double>({surface.position_m.size(), std::size_t{3}}, &surface.position_m.data()->x);
}

void PyController::record_to(const std::string& path, const std::string& image_path) {
  if (record_.sequence > 0)
    throw std::runtime_error("a recording begins with the first tick: call record_to before it");
  RecordingHeader header;
  header.scene_hash = scene_->model().scene_hash;
  header.period_ns = std::llround(1e9 * scene_->model().params.period_s);
  std::snprintf(header.scene_name, sizeof header.scene_name, "%s", scene_->model().name);
  std::snprintf(header.build_id, sizeof header.build_id, "%s", kBuildId);
  std::snprintf(header.image_path, sizeof header.image_path, "%s", image_path.c_str());
  writer_ = std::make_unique<RecordingWriter>(PartFile(path, WhenItExists::kRefuse), header, block_of(*state_),
                                              pack_image(scene_->bytes()));
}

void PyController::finish_recording() {
  if (!writer_) return;
  writer_->finish();
  writer_.reset();
}

}  // namespace palpate
