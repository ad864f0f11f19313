// Boxes and hulls as what touches an elastic body: capsules along their edges, a plate on every face.
#pragma once

#include "config/scene/scene.h"

namespace palpate {

// Replaces, where the elastic body touches whole tips, every piece of shape box or hull that is one (points left out)
// by itself with points = 0, which is drawn, and after all pieces
//   a capsule of the margin's radius along every edge: an edge pressed is a line, a corner the balls at the ends of its
//     edges, of each of which the tick takes a share (LineLaw::Share); end_left has what it leaves to the others;
//   on every face wider than its edges' contacts a plate, a flat tip that stands where the body meets it.
// A face pressed flat is its plate and the frame of its edges, which lean on one another as on a half space.
// Throws ConfigError for cores in a plane, margins of 0 and more edges and faces than a tool has pieces.
void take_apart_solids(SceneDesc& scene);

}  // namespace palpate
