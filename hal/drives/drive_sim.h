// Simulated drives of any protocol: what a program or a test that plays the device asks of them.
#pragma once

#include "hal/drives/axis_plant.h"

namespace palpate {

class DriveSim {
 public:
  virtual ~DriveSim() = default;
  // One period: takes what came, sends, moves the handle. step_bus: the same with the handle held.
  virtual void step() noexcept = 0;
  virtual void step_bus() noexcept = 0;
  virtual bool any_enabled() const noexcept = 0;
  virtual AxisPlant& plant() noexcept = 0;
};

}  // namespace palpate
