// `palpate doctor --device` without an address: what is plugged into this computer, which driver speaks to it, and the
// next command. It listens and reads; nothing is sent, unless it is told to ask (moteus).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hal/bus/transport.h"
#include "sim_host/doctor/doctor.h"

namespace palpate {

// What a bus carried while it was listened to; `error`: why it could not be.
struct BusTraffic {
  std::vector<Frame> frames;
  std::string error;
};
using ListenTo = std::function<BusTraffic(const std::string& interface, bool fd)>;
// Identifiers of moteus controllers that answered; `error`: why none could be asked.
struct BusAnswers {
  std::vector<int> moteus;
  std::string error;
};
using AskOn = std::function<BusAnswers(const std::string& interface)>;

// CAN interfaces with the nodes heard, HID devices, and what is known by its USB numbers. An item passes when a driver
// of Palpate speaks to it; `root`: of /sys. Never empty. `ask`, if any, is called for CAN FD interfaces where no
// classic frame was heard: nodes that know no CAN FD spoil its frames.
std::vector<DoctorItem> find_devices(const std::filesystem::path& root, const ListenTo& listen, const AskOn& ask = {});

// Half a second of everything on a CAN interface, at most 4096 frames.
BusTraffic listen_to_bus(const std::string& interface, bool fd);
// ask_moteus on an interface that nothing of Palpate drives.
BusAnswers ask_on_bus(const std::string& interface);

}  // namespace palpate
