// What a shape of tool piece is to a scene and its baker: its keys, core, tool points, surface, tip and drawing. One
// file a shape beside this one defines its card, NAME_piece; the table PALPATE_PIECE_SHAPES (rt_core/laws.h) joins
// them. What it is to the tick, support and gap, is rt_core/tool/shape. The tests run over all cards.
#pragma once

#include <span>
#include <vector>

#include "config/bake/tool_surface.h"
#include "config/response/layer_contact.h"
#include "config/scene/card.h"

namespace palpate {

// Half profile of a core of revolution in the plane (distance from the axis, z), from its lower to its upper pole,
// convex. A ring is one point off the axis, whose rounding goes all the way around.
struct CoreProfile {
  std::vector<ProfilePoint> point;
  bool ring = false;
};

struct PieceCard {
  std::span<const CardKey> sizes;                // all needed; other sizes have no effect
  const char* margin = nullptr;                  // what margin_mm is; nullptr: it has no effect
  bool has_ends = false;                         // whether touches may be plus_z or minus_z
  Refusal (*check)(const PieceDesc&) = nullptr;  // rules between its keys, beside these
  PieceCore (*core)(const PieceDesc&);           // margin given, or kAuto to be resolved
  double (*reach_m)(const PieceCore&);           // largest distance of a point of the core from its origin
  std::vector<Vec3> (*points)(const PieceCore&, std::int32_t count);  // at most `count` of its core; empty: too few
  std::vector<SurfaceSample> (*samples)(const PieceCore&);
  // Drawing: the core of revolution, or (nullptr) the corners whose hull it is.
  CoreProfile (*profile)(const PieceCore&) = nullptr;
  std::vector<Vec3> (*corners)(const PieceCore&) = nullptr;
  // Law of its whole tip; nullptr: it has none. Which end presses.
  Indenter (*tip)(const PieceDesc&) = nullptr;
  Refusal (*check_tip)(const PieceDesc&) = nullptr;
  bool has_side_tip = false;  // on an elastic body it may touch with its side, wherever it is nearest
};

const PieceCard& card_of(PieceShape shape);

// The margin is part of the outer size: at most `smallest_half_m`.
Refusal margin_within(const PieceDesc& piece, double smallest_half_m);

// Shapes for which `has` holds, as errors list them: "sphere, capsule, cone".
template <class Predicate>
std::string shapes_where(Predicate has) {
  std::string words;
  for (std::int32_t i = 0; i < ChoiceOf<PieceShape>::kCount; ++i)
    if (const auto shape = static_cast<PieceShape>(i); has(shape))
      words += (words.empty() ? "" : ", ") + std::string(word_of(shape));
  return words;
}

}  // namespace palpate
