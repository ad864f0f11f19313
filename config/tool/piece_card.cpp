#include "config/tool/piece_card.h"

#include "config/scene/schema.h"

namespace palpate {

#define PALPATE_CARD(name, word, Shape) extern const PieceCard word##_piece;
PALPATE_PIECE_SHAPES(PALPATE_CARD)
#undef PALPATE_CARD

const PieceCard& card_of(PieceShape shape) {
#define PALPATE_CARD(name, word, Shape) &word##_piece,
  static constexpr const PieceCard* kCards[] = {PALPATE_PIECE_SHAPES(PALPATE_CARD)};
#undef PALPATE_CARD
  return *kCards[static_cast<std::int32_t>(shape)];
}

Refusal margin_within(const PieceDesc& piece, double smallest_half_m) {
  if (is_auto(piece.margin_m) || piece.margin_m <= smallest_half_m) return {};
  return {"margin_mm",
          "larger than half the smallest side; allowed up to " + number_text(1e3 * smallest_half_m) + " mm"};
}

PieceCore piece_core(const PieceDesc& piece) { return card_of(piece.shape).core(piece); }

std::vector<SurfaceSample> surface_samples(const PieceCore& core) { return card_of(core.shape).samples(core); }

}  // namespace palpate
