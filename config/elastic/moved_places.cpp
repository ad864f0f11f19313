#include "config/elastic/moved_places.h"

#include <algorithm>
#include <cmath>

#include "config/elastic/surface.h"

namespace palpate::elastic {

namespace {

// Rest place, displacement and area of one facet, in the mesh's own coordinates.
template <int kDim>
struct FacetMiddle {
  Vector<kDim> x = Vector<kDim>::Zero(), u = Vector<kDim>::Zero();
  double area = 0;
};

template <int kDim>
std::vector<FacetMiddle<kDim>> facet_middles(const fem::StrainMesh<kDim>& mesh, const std::vector<double>& u_m) {
  const Surface<kDim> surface(mesh, 1);
  std::vector<FacetMiddle<kDim>> middle;
  for (const auto& facet : surface.facets()) {
    const FacetShape shape = facet_shape(facet.nodes.size(), facet_centre(facet.nodes.size()));
    middle.emplace_back();
    for (std::size_t i = 0; i < facet.nodes.size(); ++i) {
      const int n = facet.nodes[i];
      middle.back().x += shape.value[i] * surface.rest(n);
      for (int a = 0; a < kDim; ++a) middle.back().u[a] += shape.value[i] * u_m[static_cast<std::size_t>(kDim * n + a)];
    }
  }
  for (const auto& point : surface.points()) middle[static_cast<std::size_t>(point.facet)].area += point.area_m2;
  return middle;
}

}  // namespace

std::vector<MovedPlace> moved_places(const fem::StrainMesh<3>& mesh, const std::vector<double>& u_m) {
  std::vector<MovedPlace> places;
  for (const FacetMiddle<3>& m : facet_middles<3>(mesh, u_m))
    places.push_back({{m.x[0], m.x[1], m.x[2]}, {m.u[0], m.u[1], m.u[2]}, m.area});
  return places;
}

std::vector<MovedPlace> moved_places(const fem::StrainMesh<2>& profile, const std::vector<double>& u_m, Vec3 top_m) {
  constexpr double kGoldenAngle_rad = 2.399963229728653;
  std::vector<MovedPlace> places;
  for (const FacetMiddle<2>& m : facet_middles<2>(profile, u_m)) {
    if (!(m.x[0] > 1e-9)) continue;  // the axis bounds the profile, not the body
    const double angle = kGoldenAngle_rad * static_cast<double>(places.size());
    const Vec3 out{std::cos(angle), 0, std::sin(angle)};
    places.push_back(
        {top_m + m.x[0] * out + Vec3{0, m.x[1], 0}, m.u[0] * out + Vec3{0, m.u[1], 0}, 2 * kPi * m.x[0] * m.area});
  }
  return places;
}

std::vector<MovedPlace> thinned(const std::vector<MovedPlace>& places, Vec3 near_m, double fine_m) {
  std::vector<MovedPlace> order = places;
  const auto distance = [&](const MovedPlace& p) { return norm(p.rest_m - near_m); };
  std::ranges::stable_sort(order, {}, distance);
  std::vector<MovedPlace> kept;
  for (const MovedPlace& place : order) {
    const double apart = fine_m + kThinned * distance(place);
    const auto beside = [&](const MovedPlace& k) { return norm(k.rest_m - place.rest_m) < apart; };
    if (std::ranges::any_of(kept, beside)) continue;
    kept.push_back(place);
    kept.back().area_m2 = 0;
  }
  for (const MovedPlace& place : order)
    std::ranges::min_element(kept, {}, [&](const MovedPlace& k) { return norm(k.rest_m - place.rest_m); })->area_m2 +=
        place.area_m2;
  return kept;
}

}  // namespace palpate::elastic
