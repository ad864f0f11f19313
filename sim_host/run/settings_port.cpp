#include "sim_host/run/settings_port.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <charconv>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace palpate {

namespace {

constexpr std::size_t kMostBytes = 4096;
constexpr int kAnswer_ms = 15000;  // a host looks 20 times a second, and may read an image first
constexpr char kRefused[] = "refused: ";

struct Name {
  sockaddr_un address{};
  socklen_t bytes = 0;
};
// In the abstract namespace: nothing is left behind by a host that is killed.
Name name_of(pid_t host) {
  Name name;
  name.address.sun_family = AF_UNIX;
  const std::string text = fmt::format("palpate-settings-{}", host);
  std::memcpy(name.address.sun_path + 1, text.data(), text.size());
  name.bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  return name;
}
const sockaddr* pointer(const Name& name) { return reinterpret_cast<const sockaddr*>(&name.address); }

// Whether the process at the other end runs as the same user, or as root.
bool is_trusted(int fd) {
  ucred who{};
  socklen_t bytes = sizeof who;
  return getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &who, &bytes) == 0 && (who.uid == geteuid() || who.uid == 0);
}

std::string received(int fd, int wait_ms) {
  pollfd ready{fd, POLLIN, 0};
  char text[kMostBytes];
  if (::poll(&ready, 1, wait_ms) <= 0) return "";
  const ssize_t bytes = recv(fd, text, sizeof text, MSG_DONTWAIT);
  return bytes > 0 ? std::string(text, static_cast<std::size_t>(bytes)) : "";
}

void send_text(int fd, const std::string& text) {
  if (send(fd, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0) return;  // who asked has gone
}

std::string set_one(std::string_view word, LiveSettings& settings) {
  const std::size_t equals = word.find('=');
  const std::string_view name = word.substr(0, equals);
  const std::string_view value = equals == std::string_view::npos ? "" : word.substr(equals + 1);
  float number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  const bool is_number = error == std::errc() && end == value.data() + value.size() && !value.empty();
#define PALPATE_FIELD(field, lowest, highest, key, meaning)                                                       \
  if (name == #field) {                                                                                           \
    if (!is_number || !(number >= static_cast<float>(lowest) && number <= static_cast<float>(highest)))           \
      return fmt::format("{}: '{}' is not a factor from {} to {}", name, value, double{lowest}, double{highest}); \
    settings.field = number;                                                                                      \
    return "";                                                                                                    \
  }
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return fmt::format("'{}' is no setting that can change during a run; there are {}", name, settings_text({}));
}

pid_t parent_of(pid_t process) {
  std::ifstream status(fmt::format("/proc/{}/status", process));
  std::string word;
  pid_t parent = 0;
  while (status >> word)
    if (word == "PPid:") status >> parent;
  return parent;
}

int connected_to(pid_t host) {
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (fd < 0) throw std::runtime_error("no socket to be had");
  const Name name = name_of(host);
  if (connect(fd, pointer(name), name.bytes) == 0) return fd;
  close(fd);
  return -1;
}

}  // namespace

std::string apply_settings(std::string_view words, LiveSettings& settings) {
  LiveSettings wanted = settings;
  while (!words.empty()) {
    const std::size_t blank = words.find(' ');
    const std::string_view word = words.substr(0, blank);
    words.remove_prefix(blank == std::string_view::npos ? words.size() : blank + 1);
    if (word.empty()) continue;
    if (const std::string wrong = set_one(word, wanted); !wrong.empty()) return wrong;
  }
  settings = wanted;
  return "";
}

std::string settings_text(const LiveSettings& settings) {
  std::string text;
#define PALPATE_FIELD(name, lowest, highest, key, meaning) \
  text += fmt::format("{}" #name "={:g}", text.empty() ? "" : " ", settings.name);
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return text;
}

std::string settings_help() {
  std::string text;
#define PALPATE_FIELD(name, lowest, highest, key, meaning) \
  text += fmt::format("  {:<12} {:g} to {:g}: {}\n", #name, double{lowest}, double{highest}, meaning);
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return text;
}

SettingsPort::SettingsPort() : fd_(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  const Name name = name_of(getpid());
  if (fd_ < 0 || (bind(fd_, pointer(name), name.bytes) == 0 && listen(fd_, 4) == 0)) return;
  close(fd_);
  fd_ = -1;
}

SettingsPort::~SettingsPort() {
  if (fd_ >= 0) close(fd_);
}

namespace {

std::string answer_to(const std::string& words, LiveSettings& settings, const SettingsPort::ChangeScene& change_scene) {
  if (words.starts_with(kSceneWord)) {
    const std::string image = words.substr(sizeof kSceneWord - 1);
    const std::string wrong = change_scene ? change_scene(image) : "this run keeps its scene";
    return wrong.empty() ? "goes over to " + image : kRefused + wrong;
  }
  const std::string wrong = apply_settings(words, settings);
  return wrong.empty() ? settings_text(settings) : kRefused + wrong;
}

}  // namespace

bool SettingsPort::poll(LiveSettings& settings, const ChangeScene& change_scene) {
  const LiveSettings before = settings;
  constexpr int kMostAtOnce = 8;  // who floods is answered at the next look
  for (int i = 0; i < kMostAtOnce && fd_ >= 0; ++i) {
    const int asker = accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (asker < 0) break;
    if (is_trusted(asker)) {
      send_text(asker, answer_to(received(asker, 2), settings, change_scene));
    }
    close(asker);
  }
  return !(settings == before);
}

std::string ask_run(pid_t host, const std::string& words) {
  int fd = connected_to(host);
  if (const pid_t parent = parent_of(host); fd < 0 && parent > 0) fd = connected_to(parent);
  if (fd < 0)
    throw std::runtime_error(fmt::format(
        "process {} hosts no run of yours: name the process id of `palpate run` or `palpate view` (pgrep palpate)",
        host));
  std::string answer;
  if (is_trusted(fd)) {
    send_text(fd, words.empty() ? " " : words);
    answer = received(fd, kAnswer_ms);
  }
  close(fd);
  if (answer.empty()) throw std::runtime_error(fmt::format("process {} gave no answer", host));
  if (answer.starts_with(kRefused)) throw std::runtime_error(answer.substr(sizeof kRefused - 1));
  return answer;
}

}  // namespace palpate
