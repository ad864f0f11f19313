// The last rungs of the loader ladder: cross-references and finite numbers of every array. Runs once, when an image is
// opened; after it the tick may index without checks. What a method of contact asks stands with the method
// (ContactMethod::check_tool, check_data) and is written with the words below.
#pragma once

#include "rt_core/image.h"

namespace palpate {

ImageResult check_arrays(const Model& model) noexcept;
// Whether the scene's method of contact takes its friction law and its tool: rules between parameters and pieces, which
// the baker applies to what it compiled before it starts long computations. Fields of the answer: friction_law,
// piece.hull_faces, piece.tip_points.
ImageResult check_method(const Model& model) noexcept;

inline ImageResult broken(const char* field, std::size_t index) noexcept {
  return {ImageError::kCrossReference, field, static_cast<std::int64_t>(index)};
}
inline ImageResult not_finite(const char* field, std::size_t index) noexcept {
  return {ImageError::kNotFinite, field, static_cast<std::int64_t>(index)};
}
inline ImageResult not_together(const char* field, std::size_t index) noexcept {
  return {ImageError::kCombination, field, static_cast<std::int64_t>(index)};
}
inline bool in_range(std::int64_t index, std::size_t size) noexcept {
  return index >= 0 && index < static_cast<std::int64_t>(size);
}
inline bool is_positive(double x) noexcept { return x > 0 && x < kHuge; }
inline bool is_unit(Vec3 v) noexcept { return squared_norm(v) > 0.99 && squared_norm(v) < 1.01; }
inline bool is_unit(Quat q) noexcept {
  const Real s = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return s > 0.99 && s < 1.01;
}
template <class Number>
ImageResult check_numbers(std::span<const Number> values, const char* field) noexcept {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!is_finite(static_cast<Real>(values[i]))) return not_finite(field, i);
  return {};
}

}  // namespace palpate
