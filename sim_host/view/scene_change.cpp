#include "sim_host/view/scene_change.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "config/bake/compile.h"
#include "config/bake/image_writer.h"

namespace palpate {

namespace {

// The run on this machine comes first.
void be_nice() {
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);  // refused: then as before
}

void bake(const SceneChoice& choice, const std::string& image, const Progress& progress) {
  const CompileResult compiled = compile_scene(load_scene(choice.scene, choice.overlays), {progress, 1});
  std::string error;
  if (!save_image(image, compiled.bytes, error)) throw std::runtime_error(error);
}

}  // namespace

LiveScene::LiveScene(SceneChoice of, const std::string& image_path)
    : choice(std::move(of)),
      image(image_path),
      title(image.model().name),
      track(image.model().params.period_s),
      initial(make_state(image.model())) {
  for (const std::string& file : choice.overlays.file) title += " + " + std::filesystem::path(file).stem().string();
}

SceneChange::~SceneChange() {
  ending_.store(true);
  if (thread_.joinable()) thread_.join();
}

bool SceneChange::ask(const SceneChoice& choice) {
  {
    const std::lock_guard lock(mutex_);
    if (news_.going_on()) return false;
    news_ = {Stage::kBaking, title_of(choice), "is read", 0};
    since_ = std::chrono::steady_clock::now();
  }
  if (thread_.joinable()) thread_.join();  // of the change before, which has ended
  thread_ = std::thread([this, choice] { prepare(choice); });
  return true;
}

void SceneChange::prepare(SceneChoice choice) {
  be_nice();
  try {
    const std::string image = image_of(choice);
    auto next = std::make_shared<LiveScene>(std::move(choice), image);
    const std::lock_guard lock(mutex_);
    asked_ = std::move(next);
    asked_image_ = image_ = image;
    news_.stage = Stage::kAsking;
    news_.words = "the controller reads and checks it";
  } catch (const std::exception& error) {
    say(Stage::kRefused, error.what());
  }
}

// Its image, as it is, from before, or baked now.
std::string SceneChange::image_of(const SceneChoice& choice) {
  if (is_image(choice.scene)) {
    if (const std::string wrong = why_not(choice); !wrong.empty()) throw std::runtime_error(wrong);
    return std::filesystem::absolute(choice.scene).string();
  }
  if (const auto known = baked_.find(choice.key()); known != baked_.end()) return known->second;
  const std::string image = folder_.file(fmt::format("{}.pal", ++images_).c_str());
  say(Stage::kBaking, "is baked");
  bake(choice, image, [this](const char* what, double fraction) {
    if (ending_.load()) throw std::runtime_error("the viewer was closed");
    say(Stage::kBaking, fmt::format("is baked: {} {:.0f} %", what, 100 * fraction));
  });
  baked_[choice.key()] = image;
  return image;
}

void SceneChange::say(Stage stage, const std::string& words) {
  const std::lock_guard lock(mutex_);
  news_.stage = stage;
  news_.words = words;
  if (stage == Stage::kThere || stage == Stage::kRefused) since_ = std::chrono::steady_clock::now();
}

SceneChange::News SceneChange::news() const {
  const std::lock_guard lock(mutex_);
  News news = news_;
  news.since_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - since_).count();
  return news;
}

SceneChoice SceneChange::now() const {
  const std::lock_guard lock(mutex_);
  return now_;
}

std::string SceneChange::image_wanted() {
  const std::lock_guard lock(mutex_);
  return std::exchange(image_, "");
}

void SceneChange::refused(const std::string& wrong) {
  say(Stage::kRefused, wrong);
  const std::lock_guard lock(mutex_);
  asked_.reset();
}

std::shared_ptr<LiveScene> SceneChange::accepted(const std::string& image) {
  const std::unique_lock lock(mutex_);
  if (asked_ && image == asked_image_) {
    own_ = std::exchange(asked_, nullptr);
    news_.stage = Stage::kGoing;
    news_.words = "force ramps to zero, then it is there";
    accepted_.push_back(own_);
  } else {
    accepted_.push_back(std::make_shared<LiveScene>(SceneChoice{image, {}}, image));
  }
  return accepted_.back();
}

std::shared_ptr<LiveScene> SceneChange::arrived() {
  std::shared_ptr<LiveScene> next;
  bool own = false;
  {
    const std::lock_guard lock(mutex_);
    if (accepted_.empty()) return nullptr;
    next = std::move(accepted_.front());
    accepted_.pop_front();
    now_ = next->choice;
    own = std::exchange(own_, own_ == next ? nullptr : own_) == next;
  }
  if (own) say(Stage::kThere, "is there; force comes back as after a start");
  return next;
}

}  // namespace palpate
