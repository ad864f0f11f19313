#include "sim_host/bake/image_dump.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <string_view>

namespace palpate {

namespace {

// Smallest and largest of every number an array holds; for structs, of their positions.
struct Range {
  double low = 0, high = 0;
  bool any = false;
  void add(double x) {
    low = any ? std::min(low, x) : x;
    high = any ? std::max(high, x) : x;
    any = true;
  }
  void add(Vec3 v) { add(v.x), add(v.y), add(v.z); }
};

void extend(Range& range, double x) { range.add(x); }
void extend(Range& range, Vec3 v) { range.add(v); }
void extend(Range& range, const Triangle& t) {
  for (const std::int32_t v : t.vertex) range.add(v);
}
void extend(Range& range, const BvhNode& node) {
  for (int k = 0; k < 4; ++k) {
    if (node.child[k] == -1 && node.count[k] == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      range.add(static_cast<double>(node.lower_m[axis][k]));
      range.add(static_cast<double>(node.upper_m[axis][k]));
    }
  }
}
void extend(Range& range, const Anchor& a) { range.add(a.position_m); }
void extend(Range& range, const StageCost& s) { range.add(s.instructions); }
void extend(Range& range, const PatchWeight& p) {
  for (const double w : p.weight) range.add(w);
}
void extend(Range& range, const ToolPiece& p) { range.add(p.pose_tool.position_m); }
void extend(Range& range, const HullFace& f) { range.add(f.offset_m); }
void extend(Range& range, const Joint& j) { range.add(j.lowest), range.add(j.highest); }
void extend(Range& range, const Pose& p) { range.add(p.position_m); }
void extend(Range& range, const ToolPoint& p) { range.add(p.position_tool_m); }
void extend(Range& range, const BeamStiffness& b) {
  for (const double k : b.k_N_per_m) range.add(k);
}
void extend(Range& range, const BeamRatio& b) {
  range.add(b.f1_gain_N_per_m);
  range.add(b.f2_gain_N_per_m);
}
void extend(Range& range, const BeamResponse& b) {
  for (const Vec3& row : b.release_m_per_N) range.add(row);
}
void extend(Range& range, const NodalVertex& v) { range.add(v.area_m2); }
void extend(Range& range, float x) { range.add(static_cast<double>(x)); }
void extend(Range& range, std::int32_t i) { range.add(i); }
void extend(Range& range, const CornerNormals& n) {
  for (const Vec3& v : n.normal) range.add(v);
}
void extend(Range& range, const TipLaw& t) { range.add(t.force_max_N); }
void extend(Range& range, const FactorKnot& k) { range.add(k.value); }
void extend(Range& range, const TipPair& p) { range.add(p.c_m_per_N); }
void extend(Range& range, const ResponseKnot& k) { range.add(k.force_N); }

template <typename T>
std::string array_row(const char* name, std::span<const T> values, const char* frame, const char* meaning) {
  Range range;
  for (const T& value : values) extend(range, value);
  const std::string spread = range.any ? fmt::format("{:.5g} .. {:.5g}", range.low, range.high) : "-";
  return fmt::format("  {:<16}{:>10}{:>12}  {:<24}{:<7}{}\n", name, values.size(), values.size_bytes(), spread, frame,
                     meaning);
}

template <typename T>
Json array_json(const char* name, std::span<const T> values, const char* frame, const char* meaning) {
  Range range;
  for (const T& value : values) extend(range, value);
  Json json = {{"name", name}, {"elements", values.size()}, {"bytes", values.size_bytes()}};
  if (range.any) json.update({{"lowest", range.low}, {"highest", range.high}});
  json.update({{"frame", frame}, {"meaning", meaning}});
  return json;
}

template <class T>
Json value_json(T value) {
  if constexpr (Choice<T>)
    return word_of(value);
  else
    return value;
}

// A choice by its word.
template <class T>
std::string value_text(T value) {
  if constexpr (Choice<T>)
    return word_of(value);
  else
    return fmt::format("{:.7g}", static_cast<double>(value));
}

}  // namespace

std::string image_dump(const ImageHeader& header, const Model& model) {
  const std::string_view name(header.name, strnlen(header.name, sizeof header.name));
  std::string text = fmt::format(
      "scene         {}\nversion       {}\nbytes         {}\nlayout hash   {:016x}\nchecksum      "
      "{:016x}\n\nparameters\n",
      name, header.version, header.total_bytes, header.layout_hash, header.checksum);
  const auto out = std::back_inserter(text);
#define PALPATE_ROW(type, field, unit, lowest, highest, meaning) \
  fmt::format_to(out, "  {:<26}{:>18}  {:<11}{}\n", #field, value_text(model.params.field), unit, meaning);
#define PALPATE_GROUP(title, PARAMS, methods) \
  fmt::format_to(out, " of {}\n", title);     \
  PARAMS(PALPATE_ROW)
  PALPATE_PARAM_GROUPS(PALPATE_GROUP)
#undef PALPATE_GROUP
#undef PALPATE_ROW
  text += "\nsizes\n";
#define PALPATE_ROW(field, lowest, highest, methods) fmt::format_to(out, "  {:<16}{:>10}\n", #field, model.sizes.field);
  PALPATE_MODEL_SIZES(PALPATE_ROW)
#undef PALPATE_ROW
  text += "\narrays            elements       bytes  values                  frame  meaning\n";
#define PALPATE_ROW(type, field, count, frame, meaning) text += array_row(#field, model.field, frame, meaning);
  PALPATE_MODEL_ARRAYS(PALPATE_ROW)
#undef PALPATE_ROW
  return text;
}

Json image_json(const ImageHeader& header, const Model& model) {
  Json json = {{"name", std::string(header.name, strnlen(header.name, sizeof header.name))},
               {"version", header.version},
               {"image_bytes", header.total_bytes},
               {"layout_hash", fmt::format("{:016x}", header.layout_hash)},
               {"checksum", fmt::format("{:016x}", header.checksum)}};
#define PALPATE_ROW(type, field, unit, lowest, highest, meaning) \
  json["parameters"][#field] = value_json(model.params.field);
#define PALPATE_GROUP(title, PARAMS, methods) PARAMS(PALPATE_ROW)
  PALPATE_PARAM_GROUPS(PALPATE_GROUP)
#undef PALPATE_GROUP
#undef PALPATE_ROW
#define PALPATE_ROW(field, lowest, highest, methods) json["sizes"][#field] = model.sizes.field;
  PALPATE_MODEL_SIZES(PALPATE_ROW)
#undef PALPATE_ROW
#define PALPATE_ROW(type, field, count, frame, meaning) \
  json["arrays"].push_back(array_json(#field, model.field, frame, meaning));
  PALPATE_MODEL_ARRAYS(PALPATE_ROW)
#undef PALPATE_ROW
  return json;
}

}  // namespace palpate
