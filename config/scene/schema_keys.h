// What the schema's tables are written with: a key of each kind, from the member that holds it.
#pragma once

#include "config/scene/schema.h"

namespace palpate::schema {

template <class C, class T>
C class_of(T C::*);
template <class C, class T>
T type_of(T C::*);

template <auto member>
void* field(void* table) {
  return &(static_cast<decltype(class_of(member))*>(table)->*member);
}
template <auto member>
void set(void* table, std::int32_t value) {
  static_cast<decltype(class_of(member))*>(table)->*member = static_cast<decltype(type_of(member))>(value);
}
template <auto member>
std::int32_t get(const void* table) {
  return static_cast<std::int32_t>(static_cast<const decltype(class_of(member))*>(table)->*member);
}

template <auto member>
constexpr KeySpec number(const char* key, double lowest, double highest, double scale, const char* meaning,
                         bool required = false) {
  return {key, KeyKind::kNumber, lowest, highest, scale, required, {}, meaning, field<member>, nullptr, nullptr};
}
template <auto member>
constexpr KeySpec number_or_auto(const char* key, double lowest, double highest, double scale, const char* meaning) {
  return {key, KeyKind::kNumberOrAuto, lowest, highest, scale, false, {}, meaning, field<member>, nullptr, nullptr};
}
template <auto member>
constexpr KeySpec integer(const char* key, double lowest, double highest, const char* meaning) {
  return {key, KeyKind::kInteger, lowest, highest, 1, false, {}, meaning, field<member>, nullptr, nullptr};
}
template <auto member>
constexpr KeySpec boolean(const char* key, const char* meaning) {
  return {key, KeyKind::kBool, 0, 1, 1, false, {}, meaning, field<member>, nullptr, nullptr};
}
template <auto member>
constexpr KeySpec boolean_or_auto(const char* key, const char* meaning) {
  return {key, KeyKind::kBoolOrAuto, 0, 1, 1, false, {}, meaning, field<member>, nullptr, nullptr};
}
// For text, `highest` is the greatest length.
template <auto member>
constexpr KeySpec text(const char* key, double longest, const char* meaning, bool required = false) {
  return {key, KeyKind::kText, 1, longest, 1, required, {}, meaning, field<member>, nullptr, nullptr};
}
template <auto member>
constexpr KeySpec choice(const char* key, const char* meaning, bool required = false) {
  return {key,     KeyKind::kChoice, 0,           0,          1, required, ChoiceOf<decltype(type_of(member))>::kWord,
          meaning, nullptr,          set<member>, get<member>};
}
template <auto member>
constexpr KeySpec list(KeyKind kind, const char* key, double lowest, double highest, double scale,
                       const char* meaning) {
  return {key, kind, lowest, highest, scale, false, {}, meaning, field<member>, nullptr, nullptr};
}

inline constexpr double kMilli = 1e-3;
inline constexpr double kMilliSquared = 1e-6;
inline constexpr double kDegree = 3.14159265358979323846 / 180.0;
inline constexpr KeyKind kVec3 = KeyKind::kVec3;
inline constexpr TableCount kOne = TableCount::kOne;

// [body] and its tables (schema_body.cpp).
std::span<const KeySpec> body_keys();
std::span<const KeySpec> fem_keys();
std::span<const KeySpec> elastic_keys();
std::span<const KeySpec> material_keys();
std::span<const KeySpec> material_region_keys();
std::span<const KeySpec> fixed_keys();

}  // namespace palpate::schema
