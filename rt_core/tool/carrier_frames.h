// Where all pieces of an articulated tool are, as frames, four pieces at a time: RigidFrame(carrier_w()) to the bit, at
// 66 instructions each for 250 (2026-11-27).
#pragma once

#include "rt_core/lanes.h"
#include "rt_core/state.h"

namespace palpate {

class CarrierFrames {
 public:
  // Of `pieces` pieces at most kMaxPieces, each moved by its own motion and then by the tool's pose.
  void place(const Pose& tool_w, const Pose* motion_tool, std::int32_t pieces) PALPATE_RT;
  const RigidLanes& of(std::int32_t piece) const PALPATE_RT { return frame_[piece]; }

 private:
  RigidLanes frame_[whole_lanes(kMaxPieces, 4)];
};

}  // namespace palpate
