#include "sim_host/run/host_connection.h"

#include <sys/socket.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>

#include "sim_host/build_id.h"
#include "sim_host/rings/telemetry_schema.h"

namespace palpate {

namespace {

constexpr int kSocketTimeout_ms = 2000;

}  // namespace

std::string HostConnection::share_telemetry(const Model& model, const std::string& image, const std::string& path) {
  std::string error;
  telemetry = SharedMemory::create("palpate-telemetry", sizeof(TelemetryRegion), error);
  if (!telemetry) return "telemetry: " + error;
  auto& region = *static_cast<TelemetryRegion*>(telemetry.data());
  const std::unique_ptr<char, void (*)(void*)> full(realpath(image.c_str(), nullptr), std::free);
  writer.open(region, model, static_cast<std::int64_t>(model.params.period_s * 1e9 + 0.5), kBuildId,
              full ? full.get() : image.c_str());
  describe_telemetry(region);
  if (!path.empty() && !door.open(path, telemetry.fd(), error)) return "--telemetry " + error;
  return "";
}

std::string HostConnection::connect(int control_fd) {
  std::string error;
  const int fd = receive_descriptor(control_fd, 'C', kSocketTimeout_ms, error);
  if (fd >= 0) mailbox = SharedMemory::open_peer(fd, sizeof(MailboxRegion), error);
  if (!mailbox) return "the host's command region is refused: " + error;
  if (const char* wrong = check_mailbox(*mailbox_region()))
    return std::string("the host's command region is of another build (") + wrong + ")";
  return send_descriptor(control_fd, 'T', telemetry.fd(), error) ? "" : error;
}

void HostConnection::hear(int control_fd, SceneShelf& shelf) {
  char text[2048];
  const ssize_t got = recv(control_fd, text, sizeof text, MSG_DONTWAIT);
  if (got < 1) return;
  const std::string path(text + 1, static_cast<std::size_t>(got - 1));
  std::string wrong = "not understood";
  if (text[0] == kAnnounce) {
    try {
      wrong = shelf.add(
          path, [&](std::uint64_t number, const Model& next) { writer.announce_scene(number, next, path.c_str()); });
    } catch (const std::bad_alloc&) {
      wrong = path + ": no memory for it";
    }
  }
  const std::string answer = (wrong.empty() ? kReady : kRefuses) + wrong;
  if (send(control_fd, answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0)
    std::fprintf(stderr, "controller: the host does not hear what became of %s\n", path.c_str());
}

const Model& HostConnection::newest_model(const SceneShelf& shelf, const Model& first) const {
  const TelemetryScene* scene = newest_scene(ring());
  return scene == nullptr ? first : shelf.at(static_cast<std::uint64_t>(scene - ring().later_scene) + 1)->model;
}

}  // namespace palpate
