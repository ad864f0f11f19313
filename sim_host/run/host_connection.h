// What the controller shares: telemetry with whoever reads, commands with the host that started it. Set up before the
// loop; a member function that fails says why.
#pragma once

#include <string>

#include "hal/system/shared_memory.h"
#include "rt_core/model.h"
#include "sim_host/rings/mailbox.h"
#include "sim_host/rings/telemetry_door.h"
#include "sim_host/run/scene_shelf.h"

namespace palpate {

struct HostConnection {
  SharedMemory mailbox, telemetry;  // empty without a host, and without a reader
  TelemetryWriter writer;
  TelemetryDoor door;

  // The ring of a controller that renders `image`; readers come to the socket `path`, unless that is empty.
  std::string share_telemetry(const Model& model, const std::string& image, const std::string& path);
  // Takes the host's command region and gives it the ring, over the socket between the two.
  std::string connect(int control_fd);
  // While the loop runs: the host has said something on that socket. It announces a scene, and is answered.
  void hear(int control_fd, SceneShelf& shelf);
  // Of the scene that the newest records are of; `first`: that the run began with.
  const Model& newest_model(const SceneShelf& shelf, const Model& first) const;
  const MailboxRegion* mailbox_region() const { return static_cast<const MailboxRegion*>(mailbox.data()); }
  const TelemetryRegion& ring() const { return *static_cast<const TelemetryRegion*>(telemetry.data()); }
};

}  // namespace palpate
