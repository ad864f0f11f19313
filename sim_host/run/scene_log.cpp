#include "sim_host/run/scene_log.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "sim_host/record/recorded_image.h"

namespace palpate {

namespace {

// run.plr, 2: run.scene-2.plr.
std::string name_of(const std::string& record, std::size_t number) {
  const std::filesystem::path path(record);
  return (path.parent_path() / fmt::format("{}.scene-{}{}", path.stem().string(), number, path.extension().string()))
      .string();
}

template <std::size_t N>
void copy_text(char (&to)[N], const std::string& from) {
  std::memset(to, 0, N);
  from.copy(to, N - 1);
}

}  // namespace

SceneLog::SceneLog(const SceneLogOptions& options, const RecordingHeader& header, const ImageFile& image,
                   std::optional<PartFile> file)
    : options_(options), header_(header) {
  scene_.push_back(begin(image, std::move(file)));
}

std::unique_ptr<SceneLog::Kept> SceneLog::begin(const ImageFile& image, std::optional<PartFile> file) {
  auto kept = std::make_unique<Kept>();
  const Model& model = image.model();
  kept->initial = make_state(model);
  std::vector<PackedPiece> packed;
  if (file || !options_.black_box.empty()) packed = pack_image(image.bytes());
  if (file) kept->file = std::make_unique<RecordingWriter>(std::move(*file), header_, block_of(*kept->initial), packed);
  begun_ += 1;
  if (!options_.black_box.empty()) {
    const std::string prefix = options_.black_box + (begun_ == 1 ? "" : fmt::format(".scene-{}", begun_));
    kept->box = std::make_unique<BlackBox>(prefix, header_, *kept->initial, &model, options_.candump, packed);
  }
  kept->grasp = std::make_unique<GraspWatch>(model);
  return kept;
}

void SceneLog::expect(const std::string& path, std::uint64_t scene_hash) {
  auto image = std::make_unique<ImageFile>(path);
  if (image->model().scene_hash != scene_hash)
    throw std::runtime_error(path + ": has changed since the controller read it");
  header_.scene_hash = scene_hash;
  copy_text(header_.scene_name, image->model().name);
  copy_text(header_.image_path, path);
  std::optional<PartFile> file;
  if (!options_.record.empty()) file.emplace(name_of(options_.record, begun_ + 1), options_.exists);
  std::unique_ptr<Kept> next = begin(*image, std::move(file));
  next->image = std::move(image);
  const std::lock_guard lock(mutex_);
  expected_.push_back(std::move(next));
}

RecordingWriter* SceneLog::turn(std::uint64_t first, bool whole) {
  const std::lock_guard lock(mutex_);
  if (expected_.empty()) return file();
  if (now().box) now().box->finish("");
  scene_.push_back(std::move(expected_.front()));
  expected_.pop_front();
  if (file() != nullptr) file()->begin_slice(first, whole);
  if (now().box) now().box->begin_at(first, whole);
  return file();
}

void SceneLog::add(const TickRecord& record) {
  now().grasp->take(record);
  if (now().box) now().box->add(record);
}

void SceneLog::finish(const std::string& death) {
  if (now().box) now().box->finish(death);
}

std::vector<BlackBoxDump> SceneLog::dumps() const {
  std::vector<BlackBoxDump> all;
  for (const auto& kept : scene_)
    if (kept->box) all.insert(all.end(), kept->box->dumps().begin(), kept->box->dumps().end());
  return all;
}

std::string SceneLog::black_box_error() const {
  for (const auto& kept : scene_)
    if (kept->box && !kept->box->error().empty()) return kept->box->error();
  return "";
}

std::string SceneLog::grasp() const {
  std::string text;
  for (const auto& kept : scene_) text += kept->grasp->text();
  return text;
}

std::vector<std::string> SceneLog::later_recordings() const {
  std::vector<std::string> paths;
  for (std::size_t i = 1; i < scene_.size(); ++i)
    if (scene_[i]->file) paths.push_back(scene_[i]->file->path());
  return paths;
}

}  // namespace palpate
