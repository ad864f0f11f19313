#include "config/response/press_table.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>

#include "config/bake/contact_fit.h"
#include "config/body/body_card.h"
#include "config/fem/series_fit.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

const char* const kKey = "contact.table.source";
// Equal steps of the root of the depth: a cubic with exact slopes misses Hertz' law nowhere and a cone's by 1e-6.
constexpr int kKnots = 33;
// Least stiffness of a whole curve as a share of the tip's own: below it the far field is nearly unstable.
constexpr double kLeastStiffness = 0.05;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The one shape of all tips that touch; the scene check has seen that there is one.
const PieceDesc& only_tip(const SceneDesc& scene) {
  const PieceDesc* tip = nullptr;
  for (std::size_t i = 0; i < scene.piece.size(); ++i) {
    const PieceDesc& piece = scene.piece[i];
    if (piece.points == 0) continue;
    if (tip == nullptr) tip = &piece;
    const bool same = piece.shape == tip->shape && piece.radius_m == tip->radius_m &&
                      tip_indenter(piece).tan_half_angle == tip_indenter(*tip).tan_half_angle;
    if (!same)
      throw ConfigError(scene.source.where("tool.piece[" + std::to_string(i) + "]") +
                        ": a table holds the response of one tip, and this piece has another shape; make all touching "
                        "pieces alike, or set contact.law = \"tool\"");
  }
  return *tip;
}

// Tip and body at a place, as tip_bake.h describes them.
class PlaceTips {
 public:
  explicit PlaceTips(const SceneDesc& scene) : scene_(scene), piece_(only_tip(scene)) {
    const double nu = effective_poisson_ratio(scene.material);
    modulus_Pa_ = scene.material.youngs_modulus_Pa / (1 - nu * nu);
  }

  TipDesc at(const PressPlace& place) const {
    TipDesc tip;
    tip.modulus_Pa = modulus_Pa_;
    tip.depth_max_m = scene_.contact.max_depth_m;
    tip.indenter = tip_indenter(piece_);
    const auto layer_m = card_of(scene_.body.shape).layer_m;
    if (place.pressed_face && layer_m != nullptr)
      tip.layer = {layer_m(scene_.body), effective_poisson_ratio(scene_.material), scene_.layer.base};
    if (tip.indenter.profile == TipProfile::kSphere)
      tip.indenter.radius_m = elliptic_radius_m(1 / piece_.radius_m + place.curvature_1_per_m,
                                                1 / piece_.radius_m + place.curvature_2_per_m);
    return tip;
  }
  const PieceDesc& piece() const { return piece_; }
  double modulus_Pa() const { return modulus_Pa_; }

 private:
  const SceneDesc& scene_;
  const PieceDesc& piece_;
  double modulus_Pa_ = 0;
};

// The laws of all places, each made once: places of one curvature and kind share theirs.
class PlaceLaws {
 public:
  explicit PlaceLaws(const PlaceTips& tips) : tips_(tips) {}
  const OwnedLaw& at(const PressPlace& place) {
    const std::array<double, 3> name{place.curvature_1_per_m, place.curvature_2_per_m, place.pressed_face ? 1.0 : 0.0};
    const auto known = law_.find(name);
    return known != law_.end() ? known->second : law_.emplace(name, make_owned_law(tips_.at(place))).first->second;
  }

 private:
  const PlaceTips& tips_;
  std::map<std::array<double, 3>, OwnedLaw> law_;
};

// To the micrometre.
std::string mm_text(double length_m) { return number_text(std::round(1e6 * length_m) / 1e3) + " mm"; }

[[noreturn]] void fail(const SceneDesc& scene, const char* key, const std::string& what) {
  throw ConfigError(scene.source.where(key) + ": " + what);
}

void check_depth(const SceneDesc& scene, const PlaceTips& tips, const std::vector<PressPlace>& places) {
  const double depth = scene.contact.max_depth_m;
  const auto layer_m = card_of(scene.body.shape).layer_m;
  const double height = layer_m != nullptr ? layer_m(scene.body) : kHuge;
  if (!(depth < height))
    fail(scene, "contact.max_depth_mm",
         mm_text(depth) + " is not less than the body's height of " + mm_text(height) + "; lower it");
  for (const PressPlace& place : places) {
    const Indenter tip = tips.at(place).indenter;
    if (tip.profile == TipProfile::kSphere && !(depth <= tip.radius_m))
      fail(scene, "contact.max_depth_mm",
           mm_text(depth) + " is more than the effective radius of tip and body, " + mm_text(tip.radius_m) +
               "; lower it");
  }
}

PressSeries press_top(const SceneDesc& scene, const PlaceTips& tips, const PressPlace& top) {
  const TipDesc tip = tips.at(top);
  const OwnedLaw law = make_owned_law(tip);
  const fem::PressBody body = pressed_body(scene, kKey);
  const fem::RigidTool tool = pressed_tool(tips.piece(), tip_indenter(tips.piece()), tip.depth_max_m);
  try {
    return press_series(body, tool, law.local(), tip.depth_max_m, press_elements(tool.shape));
  } catch (const ConfigError& error) {
    fail(scene, kKey,
         std::string(error.what()) +
             "; lower contact.max_depth_mm, press with a blunter tool, or set contact.law = \"tool\"");
  }
}

}  // namespace

std::vector<ResponseKnot> press_row(const LocalLaw& local, const FarSeries& far, double extra_m_per_N,
                                    const std::vector<double>& knot) {
  std::vector<ResponseKnot> row(knot.size(), ResponseKnot{});
  const auto travel_m = [&](double indentation_m) {
    const double force_N = local_at(local, indentation_m).force_N;
    return indentation_m + far.travel_m(force_N) + extra_m_per_N * force_N;
  };
  const auto indentation_of = fem::inverse_of(travel_m, knot.back() * knot.back());
  for (std::size_t k = 1; k < knot.size(); ++k) {
    const LawPoint point = local_at(local, indentation_of(knot[k] * knot[k]));
    const double share = 1 + (far.slope_m_per_N(point.force_N) + extra_m_per_N) * point.tangent_N_per_m;
    if (!(share >= kLeastStiffness && point.force_N > row[k - 1].force_N))
      throw ConfigError("at " + mm_text(knot[k] * knot[k]) + " the body would give way faster than it is pressed");
    row[k].force_N = point.force_N;
    row[k].slope = 2 * knot[k] * point.tangent_N_per_m / share;
  }
  // Three times the rise per step on either side keeps a cubic monotone (Fritsch & Carlson 1980).
  for (std::size_t k = 0; k + 1 < knot.size(); ++k) {
    const double rise = (row[k + 1].force_N - row[k].force_N) / (knot[k + 1] - knot[k]);
    for (ResponseKnot* end : {&row[k], &row[k + 1]}) end->slope = std::min(end->slope, 3 * rise);
  }
  integrate_curve(knot, true, row);
  return row;
}

PressTable press_table(const SceneDesc& scene, const std::vector<Vec3>& vertex_m, const Progress& progress) {
  pressed_body(scene, kKey);  // refuses other bodies
  PressTable result;
  const PlaceTips tips(scene);
  result.places = press_places(scene, vertex_m);
  const std::vector<PressPlace>& place = result.places.place;
  check_depth(scene, tips, place);
  const double start = seconds_now();
  result.top = press_top(scene, tips, place[0]);
  result.press_s = seconds_now() - start;
  const Indenter widest = tips.at(place[0]).indenter;
  const double contact = widest.profile == TipProfile::kSphere ? std::sqrt(widest.radius_m * scene.contact.max_depth_m)
                         : widest.profile == TipProfile::kFlat ? widest.radius_m
                                                               : scene.contact.max_depth_m * widest.tan_half_angle;
  result.compliance = place_compliance(scene, place, contact, progress);
  result.place_s = seconds_now() - start - result.press_s;
  for (int k = 0; k < kKnots; ++k) result.table.knot.push_back(std::sqrt(scene.contact.max_depth_m) * k / (kKnots - 1));
  PlaceLaws laws(tips);
  const double half_space = half_space_patch_m_per_N(tips.modulus_Pa(), result.compliance.patch_m);
  for (std::size_t i = 0; i < place.size(); ++i) {
    const LocalLaw local = laws.at(place[i]).local();
    const double here = result.compliance.m_per_N[i];
    try {
      result.table.row.push_back(
          place[i].pressed_face
              ? press_row(local, result.top.far, here - result.compliance.m_per_N[0], result.table.knot)
              : press_row(local, {}, std::max(here - half_space, 0.0), result.table.knot));
    } catch (const ConfigError& error) {
      fail(scene, "contact.max_depth_mm", std::string(error.what()) + "; lower it");
    }
  }
  return result;
}

std::vector<std::string> describe(const PressTable& table) {
  const auto text = [](const char* pattern, auto... values) {
    char buffer[256];
    std::snprintf(buffer, sizeof buffer, pattern, values...);
    return std::string(buffer);
  };
  double lowest = 0, highest = 0;
  for (std::size_t i = 0; i < table.places.place.size(); ++i) {
    if (!table.places.place[i].pressed_face) continue;
    const double more = table.compliance.m_per_N[i] - table.compliance.m_per_N[0];
    lowest = std::min(lowest, more);
    highest = std::max(highest, more);
  }
  const FarSeries& far = table.top.far;
  return {text("pressed at the top to %.4g mm: %d large-strain solves with %d elements under the tool, %.1f s",
               1e3 * table.top.press.back().depth_m, static_cast<int>(table.top.press.size()), table.top.elements,
               table.press_s),
          text("largest force %.4g N; the curve misses a press by %.2f %% of its depth at most", far.force_max_N,
               100 * table.top.misfit),
          text("c0 = %.4g mm/N, c1 = %.4g mm/N2, c2 = %.4g mm/N3", 1e3 * far.c0_m_per_N, 1e3 * far.c1_m_per_N2,
               1e3 * far.c2_m_per_N3),
          text("%d places; compliance of the pressed face relative to its top %.4g to %.4g mm/N (%d nodes, load over "
               "%.3g mm), %.1f s",
               static_cast<int>(table.places.place.size()), 1e3 * lowest, 1e3 * highest,
               static_cast<int>(table.compliance.nodes), 1e3 * table.compliance.patch_m, table.place_s)};
}

}  // namespace palpate
