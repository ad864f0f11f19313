#include "sim_host/view/stroke_font.h"

#include <algorithm>

namespace palpate {

namespace {

// Glyphs on a grid: x is a digit, y a letter from 'a' (-3, descender) over 'd' (0, baseline) and 'j' (6, lower-case
// height) to 'm' (9, capital height). Strokes are separated by blanks and start with their kind: '-' straight
// polyline, '~' open curve, 'o' closed curve; the points of curves are the control polygon of a quadratic B-spline.
struct Glyph {
  char32_t code;
  int width;
  const char* strokes;
};

constexpr Glyph kGlyphs[] = {
    {' ', 2, ""},
    {'!', 0, "-0m0g -0d0d"},
    {'"', 2, "-0m0k -2m2k"},
    {'#', 6, "-1d2m -4d5m -0g6g -0j6j"},
    {'%', 6, "o0j2j2m0m o4d6d6g4g -0d6m"},
    {'&', 6, "~6d1j1m4m4j0g0d4d6h"},
    {'\'', 0, "-0m0k"},
    {'(', 2, "~2m0k0e2c"},
    {')', 2, "~0m2k2e0c"},
    {'*', 4, "-2e2i -0f4h -0h4f"},
    {'+', 4, "-0g4g -2e2i"},
    {',', 1, "-1d0b"},
    {'-', 4, "-0g4g"},
    {'.', 0, "-0d0d"},
    {'/', 4, "-0c4m"},
    {'0', 5, "o0d5d5m0m"},
    {'1', 5, "-1k3m3d"},
    {'2', 5, "~0k0m5m5i0d -0d5d"},
    {'3', 5, "~0l0m5m5i2i ~2i5i5d0d0e"},
    {'4', 5, "-4d4m0f5f"},
    {'5', 5, "-5m0m0i ~0i2j5j5d0d0e"},
    {'6', 5, "o0d5d5i0i ~5m1m0j0f"},
    {'7', 5, "-0m5m2d"},
    {'8', 5, "o0d5d5i0i o0i5i5m0m"},
    {'9', 5, "o0h5h5m0m ~0d4d5g5k"},
    {':', 0, "-0d0d -0i0i"},
    {';', 1, "-1d0b -1i1i"},
    {'<', 4, "-4i0g4e"},
    {'=', 4, "-0f4f -0h4h"},
    {'>', 4, "-0i4g0e"},
    {'?', 4, "~0k0m4m4i2i2g -2d2d"},
    {'A', 6, "-0d3m6d -1g5g"},
    {'B', 6, "-3d0d0m3m -0i3i ~3m6m6i3i ~3i7i7d3d"},
    {'C', 6, "~6k6m0m0d6d6f"},
    {'D', 6, "-2d0d0m2m ~2m7m7d2d"},
    {'E', 5, "-5m0m0d5d -0i4i"},
    {'F', 5, "-5m0m0d -0i4i"},
    {'G', 6, "~6k6m0m0d6d6h -6h4h"},
    {'H', 6, "-0d0m -6d6m -0i6i"},
    {'I', 0, "-0d0m"},
    {'J', 4, "-4m4f ~4f4d0d0f"},
    {'K', 5, "-0d0m -5m0g -1h5d"},
    {'L', 5, "-0m0d5d"},
    {'M', 6, "-0d0m3g6m6d"},
    {'N', 6, "-0d0m6d6m"},
    {'O', 6, "o0d6d6m0m"},
    {'P', 5, "-0d0m3m -0h3h ~3m6m6h3h"},
    {'Q', 6, "o0d6d6m0m -4f6d"},
    {'R', 6, "-0d0m3m -0h3h ~3m6m6h3h -3h6d"},
    {'S', 6, "~6k6m0m0i6i6d0d0f"},
    {'T', 6, "-0m6m -3m3d"},
    {'U', 6, "-0m0f ~0f0d6d6f -6f6m"},
    {'V', 6, "-0m3d6m"},
    {'W', 8, "-0m2d4k6d8m"},
    {'X', 6, "-0d6m -0m6d"},
    {'Y', 6, "-0m3i6m -3i3d"},
    {'Z', 6, "-0m6m0d6d"},
    {'[', 2, "-2m0m0c2c"},
    {']', 2, "-0m2m2c0c"},
    {'^', 4, "-0k2m4k"},
    {'_', 5, "-0c5c"},
    {'a', 5, "o0d5d5j0j -5j5d"},
    {'b', 5, "-0d0m o0d5d5j0j"},
    {'c', 5, "~5i5j0j0d5d5e"},
    {'d', 5, "-5d5m o0d5d5j0j"},
    {'e', 5, "-0g5g ~5g5j0j0d5d5e"},
    {'f', 4, "~4m2m2j -2j2d -0j4j"},
    {'g', 5, "o0d5d5j0j -5j5c ~5c5a0a0b"},
    {'h', 5, "-0d0m ~0g0j5j5g -5g5d"},
    {'i', 0, "-0d0j -0l0l"},
    {'j', 2, "-2j2b ~2b2a0a -2l2l"},
    {'k', 4, "-0d0m -4j0f -1g4d"},
    {'l', 0, "-0d0m"},
    {'m', 8, "-0d0j ~0g0j4j4g -4g4d ~4g4j8j8g -8g8d"},
    {'n', 5, "-0d0j ~0g0j5j5g -5g5d"},
    {'o', 5, "o0d5d5j0j"},
    {'p', 5, "-0a0j o0d5d5j0j"},
    {'q', 5, "-5a5j o0d5d5j0j"},
    {'r', 3, "-0d0j ~0g0j3j"},
    {'s', 4, "~4i4j0j0g4g4d0d0e"},
    {'t', 4, "-2m2f ~2f2d4d -0j4j"},
    {'u', 5, "-0j0g ~0g0d5d5g -5j5d"},
    {'v', 4, "-0j2d4j"},
    {'w', 8, "-0j2d4j6d8j"},
    {'x', 5, "-0d5j -0j5d"},
    {'y', 4, "-0j2d -4j1a"},
    {'z', 5, "-0j5j0d5d"},
    {'|', 0, "-0b0m"},
    {0xB5, 5, "-0j0a ~0g0d5d5g -5j5d"},
};
constexpr Glyph kUnknown{0, 4, "-0d4d4m0m0d"};
constexpr double kCapitalHeight = 9.0, kSpacing = 2.4;

const Glyph& glyph_of(char32_t code) {
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.code == code) return glyph;
  }
  return kUnknown;
}

// Decodes one- and two-byte UTF-8; anything else becomes one unknown character per byte.
std::vector<char32_t> decode(std::string_view text) {
  std::vector<char32_t> codes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xE0) == 0xC0 && i + 1 < text.size()) {
      codes.push_back(static_cast<char32_t>((byte & 0x1F) << 6 | (static_cast<unsigned char>(text[++i]) & 0x3F)));
    } else {
      codes.push_back(byte < 0x80 ? byte : 0xFFFD);
    }
  }
  return codes;
}

// Chaikin's corner cutting (1974) converges to the quadratic B-spline of the control polygon; three rounds are smooth
// at the sizes used. Open curves keep their end points.
Stroke smooth(Stroke points, bool closed) {
  for (int round = 0; round < 3; ++round) {
    Stroke finer;
    const std::size_t n = points.size();
    if (!closed) finer.push_back(points.front());
    for (std::size_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
      const Point2 a = points[i], b = points[(i + 1) % n];
      finer.push_back({0.75 * a.x + 0.25 * b.x, 0.75 * a.y + 0.25 * b.y});
      finer.push_back({0.25 * a.x + 0.75 * b.x, 0.25 * a.y + 0.75 * b.y});
    }
    if (!closed) finer.push_back(points.back());
    points = std::move(finer);
  }
  if (closed) points.push_back(points.front());
  return points;
}

void append_glyph(const Glyph& glyph, double x0, double scale, std::vector<Stroke>& strokes) {
  std::string_view rest = glyph.strokes;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    Stroke stroke;
    for (std::size_t i = 1; i + 1 < end; i += 2) stroke.push_back({double(rest[i] - '0'), double(rest[i + 1] - 'd')});
    if (rest[0] != '-') stroke = smooth(std::move(stroke), rest[0] == 'o');
    for (Point2& p : stroke) p = {x0 + scale * p.x, -scale * p.y};
    strokes.push_back(std::move(stroke));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

}  // namespace

std::vector<Stroke> text_strokes(std::string_view text, double size) {
  const double scale = 0.72 * size / kCapitalHeight;
  std::vector<Stroke> strokes;
  double x = 0;
  for (const char32_t code : decode(text)) {
    const Glyph& glyph = glyph_of(code);
    append_glyph(glyph, x, scale, strokes);
    x += scale * (glyph.width + kSpacing);
  }
  return strokes;
}

double text_width(std::string_view text, double size) {
  double units = 0;
  for (const char32_t code : decode(text)) units += glyph_of(code).width + kSpacing;
  return 0.72 * size / kCapitalHeight * std::max(0.0, units - kSpacing);
}

}  // namespace palpate
