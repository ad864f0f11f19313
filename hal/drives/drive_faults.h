// Plays a fault script on simulated drives: at the period a line names, what they send or receive is lost, or their
// encoders freeze or jump. Of the kinds of fault_script.h those that drives can have on any bus.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/bus/transport.h"
#include "hal/device/fault_script.h"
#include "hal/drives/drive_sim.h"

namespace palpate {

class DriveFaults : public Transport {
 public:
  // `inner` must outlive this; the simulated drives speak through this.
  DriveFaults(Transport& inner, std::vector<FaultLine> lines, double period_s);
  // "" or which line is not for drives.
  static std::string refuse(const std::vector<FaultLine>& lines);

  // Before each period of `drives`, from the one in which their hand begins to move.
  void advance(DriveSim& drives);

  int send(std::span<const Frame> frames) noexcept override;
  int receive(std::span<Frame> frames) noexcept override;
  void accept_remote() noexcept override { inner_.accept_remote(); }
  void accept_extended() noexcept override { inner_.accept_extended(); }
  TransportState state() const noexcept override { return inner_.state(); }
  const TransportCounters& counters() const noexcept override { return inner_.counters(); }

 private:
  void begin(const FaultLine& line, DriveSim& drives);
  std::uint64_t after(double seconds) const noexcept;

  Transport& inner_;
  std::vector<FaultLine> lines_;
  double period_s_;
  std::size_t next_ = 0;
  std::uint64_t tick_ = 0, mute_until_ = 0, deaf_until_ = 0, frozen_until_ = 0;
};

}  // namespace palpate
