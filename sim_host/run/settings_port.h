// Live settings (rt_core/live.h) from outside a run: a local socket of the process that hosts it, named by its process
// id, and the other end that `palpate set` is. Text goes both ways: "stiffness=0.5 friction=1" there, the settings that
// are wanted now, or what is wrong, back. Only the same user, or root, is heard.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <string_view>

#include "rt_core/live.h"

namespace palpate {

// Applies "name=value" words, all or none of them. "", or what is wrong and what is allowed.
std::string apply_settings(std::string_view words, LiveSettings& settings);
// "stiffness=1 friction=1 force_limit=1 coupling=1"
std::string settings_text(const LiveSettings& settings);
// One line for each setting: name, range, meaning.
std::string settings_help();

// Instead of settings: this and the path of an image asks the run to go over to another scene.
inline constexpr char kSceneWord[] = "scene=";

// The host's end. Never waits.
class SettingsPort {
 public:
  SettingsPort();  // without a socket, where none is to be had: then nobody can ask
  ~SettingsPort();
  SettingsPort(const SettingsPort&) = delete;
  SettingsPort& operator=(const SettingsPort&) = delete;
  // Asked to go over to the scene of an image: "" when the run will, otherwise why not.
  using ChangeScene = std::function<std::string(const std::string& image)>;
  // Answers whoever has asked since; true when `settings` changed.
  bool poll(LiveSettings& settings, const ChangeScene& change_scene = {});

 private:
  int fd_ = -1;
};

// Asks the run that process `host`, or its parent, hosts. Returns its answer. Throws std::runtime_error when there is
// none, or when it refuses.
std::string ask_run(pid_t host, const std::string& words);

}  // namespace palpate
