#include "hal/drives/drive_link.h"

#include <cstdio>
#include <vector>

#include "hal/bus/loopback.h"
#include "hal/bus/socketcan.h"
#include "hal/bus/usb_bulk.h"
#include "hal/bus/usb_function.h"
#include "hal/drives/cia402_drives.h"
#include "hal/drives/cia402_sim.h"
#include "hal/drives/falcon_drives.h"
#include "hal/drives/falcon_sim.h"
#include "hal/drives/moteus_drives.h"
#include "hal/drives/moteus_sim.h"
#include "hal/drives/odrive_drives.h"
#include "hal/drives/odrive_sim.h"

namespace palpate {
namespace {

// Identifiers of what the drives send.
std::vector<std::uint32_t> replies(const ArmProfile& arm) {
  std::vector<std::uint32_t> ids;
  for (const AxisProfile& axis : arm.axes) {
    const auto node = static_cast<std::uint32_t>(axis.node);
    if (arm.protocol == DriveProtocol::kCia402) {
      using namespace canopen;
      for (const std::uint32_t cob : {kEmergency, kTpdo1, kSdoReply, kHeartbeat}) ids.push_back(cob + node);
    } else if (arm.protocol == DriveProtocol::kMoteus) {
      ids.push_back(moteus::reply_id(static_cast<int>(node)));
    } else {
      using namespace odrive;
      for (const Message message : {kGetVersion, odrive::kHeartbeat, kTxSdo, kAddress, kGetEncoderEstimates})
        ids.push_back(frame_id(static_cast<int>(node), message));
    }
  }
  return ids;
}

}  // namespace

std::unique_ptr<AxisDrives> make_drives(Transport& transport, const ArmProfile& arm, double period_s) {
  if (arm.protocol == DriveProtocol::kCia402) return std::make_unique<Cia402Drives>(transport, arm, period_s);
  if (arm.protocol == DriveProtocol::kMoteus) return std::make_unique<MoteusDrives>(transport, arm, period_s);
  if (arm.protocol == DriveProtocol::kFalcon) return std::make_unique<FalconDrives>(transport, arm, period_s);
  return std::make_unique<ODriveDrives>(transport, arm, period_s);
}

std::unique_ptr<DriveSim> make_drive_sim(Transport& transport, const ArmProfile& arm, const PlantOptions& plant,
                                         HandPath path) {
  if (arm.protocol == DriveProtocol::kCia402)
    return std::make_unique<Cia402Sim>(transport, arm, plant, std::move(path));
  if (arm.protocol == DriveProtocol::kMoteus)
    return std::make_unique<MoteusSim>(transport, arm, plant, std::move(path));
  if (arm.protocol == DriveProtocol::kFalcon)
    return std::make_unique<FalconSim>(transport, arm, plant, std::move(path));
  return std::make_unique<ODriveSim>(transport, arm, plant, std::move(path));
}

std::unique_ptr<Transport> open_drives(const DeviceAddress& address, const ArmProfile& arm, DeviceSide side,
                                       int timeout_ms, std::string& error) {
  if (address.kind == TransportKind::kLoopback) return open_transport(address, side, timeout_ms, error);
  const bool usb = arm.protocol == DriveProtocol::kFalcon;
  if ((address.kind == TransportKind::kUsb) != usb) {
    error = usb ? "a Falcon is spoken to over USB: give --device usb:/dev/bus/usb/BUS/DEVICE, as 'palpate doctor "
                  "--device' tells it, or loopback:NAME for a simulated one"
                : "drives are spoken to over CAN: give --device can:IFACE, or loopback:NAME for simulated ones";
    return nullptr;
  }
  if (usb)
    return side == DeviceSide::kDevice ? open_usb_function(address.name, error)
                                       : open_usb_bulk(address.name, falcon::kVendor, falcon::kProduct, error);
  const std::vector<std::uint32_t> ids = side == DeviceSide::kDevice ? std::vector<std::uint32_t>{} : replies(arm);
  const bool moteus = arm.protocol == DriveProtocol::kMoteus;
  return open_socketcan({address.name, moteus, ids, moteus}, error);
}

BusBudget drives_budget(const ArmProfile& arm, double period_s) {
  BusBudget budget;
  budget.rate.nominal_bit_per_s = arm.drives.bit_rate_Hz;
  budget.rate.data_bit_per_s = 5 * arm.drives.bit_rate_Hz;  // where frames have a data phase: moteus
  budget.period_us = 1e6 * period_s;
  const int axes = static_cast<int>(arm.axes.size());
  if (arm.protocol == DriveProtocol::kCia402) {
    budget.messages = {{"RPDO torque", 4, false, false, axes},
                       {"TPDO position", 6, false, false, axes},
                       {"SYNC", 0, false, false, 1},
                       {"heartbeat", 1, false, false, 1}};
  } else if (arm.protocol == DriveProtocol::kMoteus) {
    budget.messages = {{"torque and question", 32, true, true, axes}, {"answer", 16, true, false, axes}};
  } else {
    budget.messages = {{"SetInputTorque", 4, false, false, axes}, {"GetEncoderEstimates", 8, false, false, axes}};
  }
  return budget;
}

BusBudget packed_drives_budget(const ArmProfile& arm, double period_s) {
  constexpr int kSharing = 3;
  BusBudget budget = drives_budget(arm, period_s);
  const int axes = static_cast<int>(arm.axes.size());
  budget.messages[0] = {"RPDO of three", 8, false, false, (axes + kSharing - 1) / kSharing};
  budget.messages[1] = {"TPDO position", 4, false, false, axes};
  return budget;
}

// The serial line behind a Falcon's adapter carries both ways at once: 16 bytes of ten bits.
BusVerdict check_serial_line(double period_s) {
  constexpr double kBaud = 3e6 / falcon::kFastBaud;
  BusVerdict verdict;
  verdict.used_us = 1e6 * 10 * falcon::kPacketBytes / kBaud;
  verdict.available_us = 0.9e6 * period_s;
  verdict.fits = verdict.used_us <= verdict.available_us;
  return verdict;
}

BusVerdict check_drives_budget(const ArmProfile& arm, double period_s) {
  if (arm.protocol == DriveProtocol::kFalcon) return check_serial_line(period_s);
  BusVerdict verdict = check_bus_budget(drives_budget(arm, period_s));
  if (verdict.fits) return verdict;
  const BusVerdict slower = check_bus_budget(drives_budget(arm, 2 * period_s));
  const BusVerdict node = check_bus_budget(haptic_node_budget(true));
  char text[160];
  if (slower.fits) {
    std::snprintf(text, sizeof text,
                  "  half the rate fits, %.0f of %.0f us: bake the scene with device.period_ms = %g\n", slower.used_us,
                  slower.available_us, 2e3 * period_s);
    verdict.text += text;
  }
  if (arm.protocol == DriveProtocol::kCia402) {
    const BusVerdict packed = check_bus_budget(packed_drives_budget(arm, period_s));
    std::snprintf(text, sizeof text, "  packed objects would take %.0f of %.0f us%s\n", packed.used_us,
                  packed.available_us, packed.fits ? "; no driver here speaks them" : ": no way out either");
    verdict.text += text;
  }
  verdict.text += node.fits ? "  one node on CAN FD that drives all axes fits at 1 kHz (docs/wire_protocol.md)\n" : "";
  return verdict;
}

}  // namespace palpate
