// Bakes the beams of every surface vertex to every anchor: geometry by the selection rules, then mechanics.
#pragma once

#include <array>
#include <vector>

#include "config/bake/image_writer.h"
#include "config/beams/beam_rows.h"

namespace palpate {

struct BeamTableRule {
  bool paper = false;
  double width_m = 0;      // in the beam's plane; NaN: a quarter of the thinnest wall
  double thickness_m = 0;  // across it; NaN: the beams share the body's volume
  double allowance_m = 0.5e-3;
};

struct BeamTableReport {
  double wall_m = 0;  // thinnest
  double width_m = 0, thickness_m = 0, release_length_m = 0;
  std::array<std::int64_t, kBeamPaths> count{};  // by BeamPath
  std::int64_t two_ways = 0;                     // beams laid both ways round
  std::vector<std::int64_t> dropped_by_anchor;   // vertices that have no beam to it
  std::int64_t lonely_vertices = 0;              // without any beam: a contact there leaves the skeleton unloaded
};

// Fills image.beam_*, and the section and release length of image.anchor. Needs the image's surface, hierarchy and
// anchors. Throws ConfigError with the message "wall ..." when the width does not fit the wall.
BeamTableReport build_beam_table(const BeamTableRule& rule, double volume_m3, ImageContents& image);

}  // namespace palpate
