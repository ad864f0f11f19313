#include "sim_host/view/scene_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "sim_host/bake/image_file.h"

namespace palpate {

namespace {

namespace fs = std::filesystem;

fs::path folder_of(const std::string& scene) {
  const fs::path folder = fs::path(scene).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

// Files of a folder with one of the endings, by name; none where there is no such folder.
std::vector<std::string> files_in(const fs::path& folder, std::initializer_list<const char*> endings) {
  std::vector<std::string> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (std::ranges::find(endings, entry.path().extension().string()) != endings.end() && entry.is_regular_file(none))
      files.push_back(entry.path().string());
  std::ranges::sort(files);
  return files;
}

// As it is named, or beside the scene of `now`, with or without its ending.
std::string found(const std::string& name, const SceneChoice& now) {
  const fs::path beside = folder_of(now.scene) / name;
  std::error_code none;
  for (const fs::path& path : {fs::path(name), beside, fs::path(beside.string() + ".toml")})
    if (fs::is_regular_file(path, none)) return path.string();
  throw std::runtime_error(
      fmt::format("{}: no such file, here or in {}; expected a scene (.toml), an image (.pal), or an overlay as "
                  "tools/cone_30",
                  name, folder_of(now.scene).string()));
}

}  // namespace

bool is_image(const std::string& file) { return file.ends_with(".pal"); }

std::string SceneChoice::key() const {
  std::string text = scene;
  for (const std::string& file : overlays.file) text += "\nwith " + file;
  for (const std::string& setting : overlays.setting) text += "\nset " + setting;
  return text;
}

std::string title_of(const SceneChoice& choice) {
  std::string text = fs::path(choice.scene).stem().string();
  for (const std::string& file : choice.overlays.file) text += " + " + fs::path(file).stem().string();
  for (const std::string& setting : choice.overlays.setting) text += ", " + setting;
  return text;
}

SceneOffer offer_beside(const std::string& scene, const std::vector<std::string>& also) {
  SceneOffer offer;
  const fs::path folder = folder_of(scene);
  offer.scene = files_in(folder, {".toml", ".pal"});
  const auto same = [](const std::string& a, const std::string& b) {
    std::error_code none;
    return a == b || fs::equivalent(a, b, none);
  };
  for (const std::string& file : also)
    if (std::ranges::none_of(offer.scene, [&](const std::string& known) { return same(known, file); }))
      offer.scene.push_back(file);
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    if (!entry.is_directory(none)) continue;
    OverlayGroup group{entry.path().filename().string(), files_in(entry.path(), {".toml"})};
    if (!group.file.empty()) offer.group.push_back(std::move(group));
  }
  std::ranges::sort(offer.group, {}, &OverlayGroup::name);
  return offer;
}

std::string why_not(const SceneChoice& choice) {
  try {
    if (!is_image(choice.scene))
      load_scene(choice.scene, choice.overlays);
    else if (!choice.overlays.file.empty() || !choice.overlays.setting.empty())
      return choice.scene + ": is an image, which takes no overlays; choose a scene (.toml)";
    else
      ImageFile(choice.scene);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

SceneChoice choice_of(const std::string& words, const SceneChoice& now) {
  std::istringstream text(words);
  SceneChoice choice;
  std::string word;
  if (!(text >> word)) throw std::runtime_error("the scene is missing");
  choice.scene = word == "." ? now.scene : found(word, now);
  while (text >> word) {
    if (word.find('=') != std::string::npos)
      choice.overlays.setting.push_back(word);
    else
      choice.overlays.file.push_back(found(word, now));
  }
  return choice;
}

}  // namespace palpate
