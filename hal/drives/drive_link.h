// Between a profile's [drives] and the classes that speak to them: which driver, which simulator, which identifiers on
// the bus, and whether the traffic of a period fits.
#pragma once

#include <memory>
#include <string>

#include "hal/bus/bus_budget.h"
#include "hal/bus/device_address.h"
#include "hal/device/arm_profile.h"
#include "hal/drives/axis_drives.h"
#include "hal/drives/drive_sim.h"

namespace palpate {

// `transport` and `arm` must outlive what is made.
std::unique_ptr<AxisDrives> make_drives(Transport& transport, const ArmProfile& arm, double period_s);
std::unique_ptr<DriveSim> make_drive_sim(Transport& transport, const ArmProfile& arm, const PlantOptions& plant,
                                         HandPath path);

// As open_transport: on CAN with exact filters for the controller, with none for the simulated drives. Null and `error`
// on failure, or where the address cannot carry drives (USB).
std::unique_ptr<Transport> open_drives(const DeviceAddress& address, const ArmProfile& arm, DeviceSide side,
                                       int timeout_ms, std::string& error);

// What goes over the bus in every period. Heartbeats and frames of set-up come beside it now and then: the allowance
// for one error and its repeat has room for one of them.
BusBudget drives_budget(const ArmProfile& arm, double period_s);
// The same CiA 402 drives with packed objects, which no driver here speaks: one command of 8 bytes to every three of
// them (three torques and a controlword in common), and of each a position of 4 bytes alone.
BusBudget packed_drives_budget(const ArmProfile& arm, double period_s);
// The verdict; where it is refused, with what would fit.
BusVerdict check_drives_budget(const ArmProfile& arm, double period_s);

}  // namespace palpate
