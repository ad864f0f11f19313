#include "config/response/tip_bake.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/bake/contact_fit.h"
#include "config/body/body_card.h"
#include "config/hand/hand_model.h"
#include "config/response/corner_normals.h"
#include "config/response/press_bake.h"
#include "config/response/table_bake.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"
#include "config/tool/piece_card.h"
#include "rt_core/contact/tips/travel.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

// Least stiffness of the whole law as a share of the local one: below it the far field is nearly unstable.
constexpr double kLeastStiffness = 0.05;

double half_power_of(TipProfile profile) {
  return profile == TipProfile::kFlat ? 2 : profile == TipProfile::kCone ? 4 : 3;
}

// S and dS/dx at every knot, x = sqrt(e / depth_max).
std::vector<FactorKnot> factor_table(const TipDesc& tip, double coefficient) {
  // A contact on a layer is smaller than on a half space at the same depth never by more than it is at most: twice the
  // half-space radius is ample.
  double reach = tip.indenter.profile == TipProfile::kCone ? tip.depth_max_m * tip.indenter.tan_half_angle
                                                           : 2 * square_root(tip.indenter.radius_m * tip.depth_max_m);
  if (tip.indenter.profile == TipProfile::kSphere) reach = std::min(reach, tip.indenter.radius_m);
  const LayerContact contact(tip.layer, reach);
  const double power = 0.5 * half_power_of(tip.indenter.profile);
  std::vector<FactorKnot> table(kFactorKnots);
  // At zero: to first order the layer acts like a depth larger by k(0) F/(pi E*).
  const double first = power * contact.kernel_at_zero_per_m() / kPi * coefficient / tip.modulus_Pa;
  table[0] = {1.0, half_power_of(tip.indenter.profile) == 3 ? first * square_root(tip.depth_max_m) : 0.0, 0.0};
  for (int k = 1; k < kFactorKnots; ++k) {
    const double x = static_cast<double>(k) / (kFactorKnots - 1), depth = tip.depth_max_m * x * x;
    const LayerState state = contact.at_depth(tip.indenter, depth);
    const double half_space = coefficient / tip.modulus_Pa * math::pow(depth, power);
    const double value = state.force_m2 / half_space;
    table[static_cast<std::size_t>(k)] = {value, 2 / x * (state.stiffness_m * depth / half_space - power * value), 0};
  }
  return table;
}

void check_stiffness(const TipLaw& law, const LocalLaw& local) {
  for (int k = 0; k <= 512; ++k) {
    const LawPoint point = local_at(local, law.depth_max_m * k / 512.0);
    if (!(point.tangent_N_per_m >= 0))
      throw ConfigError("the tip's force falls with depth; lower contact.max_depth_mm");
    const double whole = 1 + (law.c0_m_per_N + 2 * law.c1_m_per_N2 * point.force_N) * point.tangent_N_per_m;
    if (!(whole >= kLeastStiffness))
      throw ConfigError("c0 and c1 make the contact unstable at " + number_text(point.force_N) +
                        " N: 1 + (c0 + 2 c1 F) dF/de = " + number_text(whole) + ", allowed " +
                        number_text(kLeastStiffness) + " or more; raise them or lower contact.max_depth_mm");
  }
}

}  // namespace

Indenter tip_indenter(const PieceDesc& piece) {
  if (piece.is_of_solid && piece.shape == PieceShape::kBox) return {TipProfile::kFlat, piece.radius_m, 0};
  const PieceCard& card = card_of(piece.shape);
  return card.tip != nullptr ? card.tip(piece) : Indenter{TipProfile::kSphere, piece.radius_m, 0};
}

double tip_coefficient(const Indenter& indenter, double modulus_Pa) {
  switch (indenter.profile) {
    case TipProfile::kFlat:
      return 2 * indenter.radius_m * modulus_Pa;
    case TipProfile::kParabola:
    case TipProfile::kSphere:
      return 4.0 / 3 * square_root(indenter.radius_m) * modulus_Pa;
    case TipProfile::kCone:
      return 2 / kPi * indenter.tan_half_angle * modulus_Pa;
  }
  return 0;
}

TipLaw make_tip_law(const TipDesc& tip, std::vector<FactorKnot>& factor) {
  TipLaw law{};
  law.half_power = static_cast<std::int32_t>(half_power_of(tip.indenter.profile));
  law.coefficient = tip_coefficient(tip.indenter, tip.modulus_Pa);
  law.depth_max_m = tip.depth_max_m;
  law.c0_m_per_N = tip.c0_m_per_N;
  law.c1_m_per_N2 = tip.c1_m_per_N2;
  law.first_factor = -1;
  LocalLaw local{&law, nullptr};
  if (tip.indenter.profile == TipProfile::kFlat) {
    // Geometrically similar at every depth: the factor is a number.
    const LayerContact contact(tip.layer, tip.indenter.radius_m);
    law.coefficient *= contact.at_radius(tip.indenter, tip.indenter.radius_m).stiffness_m / (2 * tip.indenter.radius_m);
  } else if (tip.layer.thickness_m > 0 || tip.indenter.profile == TipProfile::kSphere) {
    std::vector<FactorKnot> table = factor_table(tip, law.coefficient);
    local.factor = table.data();
    for (std::int32_t k = 0; k + 1 < kFactorKnots; ++k)
      table[static_cast<std::size_t>(k) + 1].energy_J =
          table[static_cast<std::size_t>(k)].energy_J + interval_energy_J(local, k);
    law.first_factor = static_cast<std::int32_t>(factor.size());
    factor.insert(factor.end(), table.begin(), table.end());
    local.factor = &factor[static_cast<std::size_t>(law.first_factor)];
  }
  law.force_max_N = local_at(local, law.depth_max_m).force_N;
  // A far field that takes travel back under force (a table's fit) would meet the plate's stiffness with a jump.
  const bool gives = law.c0_m_per_N >= 0 && law.c0_m_per_N + 2 * law.c1_m_per_N2 * law.force_max_N >= 0;
  law.limit_m = gives && tip.layer.thickness_m > tip.depth_max_m ? tip.layer.thickness_m : 0;
  check_stiffness(law, local);
  return law;
}

namespace {

// What the scene says about one piece's tip, as it touches the body.
class TipReader {
 public:
  TipReader(const SceneDesc& scene, const PieceDesc& piece, std::size_t index)
      : scene_(scene), piece_(piece), index_(index) {}

  TipDesc read(std::string& line) const {
    TipDesc tip;
    const double nu = effective_poisson_ratio(scene_.material);
    tip.modulus_Pa = scene_.material.youngs_modulus_Pa / (1 - nu * nu);
    tip.layer = {scene_.layer.thickness_m, nu, scene_.layer.base};
    tip.depth_max_m = scene_.contact.max_depth_m;
    tip.indenter = tip_indenter(piece_);
    const double angle = scene_.tip.half_angle_rad;
    if (tip.indenter.profile == TipProfile::kSphere) tip.indenter = sphere();
    if (tip.indenter.profile == TipProfile::kFlat) tip.indenter.radius_m = auto_or(stated_radius_m(), piece_.radius_m);
    if (tip.indenter.profile == TipProfile::kCone && !is_auto(angle))
      tip.indenter.tan_half_angle = math::sin(angle) / math::cos(angle);
    // A sphere's law ends at its radius: a depth that nobody stated does, too.
    if (tip.indenter.profile == TipProfile::kSphere && !scene_.source.has("contact.max_depth_mm"))
      tip.depth_max_m = std::min(tip.depth_max_m, tip.indenter.radius_m);
    if (tip.indenter.profile == TipProfile::kSphere && !(tip.depth_max_m <= tip.indenter.radius_m))
      fail("contact.max_depth_mm", number_text(std::round(1e6 * tip.depth_max_m) / 1e3) +
                                       " mm is more than the sphere's radius of " +
                                       number_text(std::round(1e6 * tip.indenter.radius_m) / 1e3) +
                                       " mm; lower it, or set contact.tip.sphere = \"parabola\"");
    add_far_field(tip);
    line = describe(tip);
    return tip;
  }

 private:
  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw ConfigError(scene_.source.where(key) + ": " + what);
  }
  double stated_radius_m() const { return piece_.is_of_solid ? kAuto : scene_.tip.radius_m; }
  static double auto_or(double stated, double otherwise) { return is_auto(stated) ? otherwise : stated; }

  // Curvatures 1/m of the body where it is touched: stated, or those of its shape.
  void body_curvature(double& first, double& second) const {
    first = second = 0;
    if (scene_.contact.backend == Backend::kElastic) return;  // the tick knows it, place by place
    if (!is_auto(scene_.tip.body_radius_1_m) || !is_auto(scene_.tip.body_radius_2_m)) {
      const auto inverse = [](double r) { return is_auto(r) || r == 0 ? 0.0 : 1 / r; };
      first = inverse(scene_.tip.body_radius_1_m);
      second = inverse(scene_.tip.body_radius_2_m);
    } else if (const auto curvature = card_of(scene_.body.shape).curvature; curvature != nullptr) {
      const BodyCurvature body = curvature(scene_.body, scene_.layer.thickness_m != 0);
      first = body.first_1_per_m;
      second = body.second_1_per_m;
    } else {
      fail("contact.tip.body_radius_1_mm",
           "missing; this body has no single curvature: state both principal radii where it is touched (0 is flat, "
           "negative is hollow)");
    }
  }

  void add_far_field(TipDesc& tip) const {
    const SeriesDesc& series = scene_.series;
    FarFieldFit fit{series.c0_m_per_N, series.c1_m_per_N2};
    if (is_auto(series.c0_m_per_N) || is_auto(series.c1_m_per_N2)) fit = fit_far_field(scene_, index_, tip);
    tip.c0_m_per_N = auto_or(series.c0_m_per_N, fit.c0_m_per_N);
    tip.c1_m_per_N2 = auto_or(series.c1_m_per_N2, fit.c1_m_per_N2);
  }

  Indenter sphere() const {
    double first = 0, second = 0;
    body_curvature(first, second);
    const double radius = auto_or(stated_radius_m(), piece_.radius_m);
    const double a = 1 / radius + first, b = 1 / radius + second;
    if (!(a > 0 && b > 0))
      fail(
          "contact.tip.body_radius_1_mm",
          "the hollow of the body is tighter than the sphere: they conform, and no contact law of one point holds; use "
          "a smaller sphere or a tabulated response");
    // Beyond an edge's radius there is no circle left, only the edge.
    const bool is_within = !piece_.is_of_solid || scene_.contact.max_depth_m <= radius;
    return {scene_.tip.sphere == SphereLaw::kExact && is_within ? TipProfile::kSphere : TipProfile::kParabola,
            elliptic_radius_m(a, b), 0};
  }

  // Radii of the body under a sphere, as the report names them.
  std::string body_text() const {
    double first = 0, second = 0;
    body_curvature(first, second);
    if (first == 0 && second == 0) return " on a flat body";
    const auto radius = [](double curvature) {
      return curvature == 0 ? std::string("flat") : number_text(std::round(1e5 / curvature) / 100) + " mm";
    };
    return " on a body of radii " + radius(first) + " and " + radius(second);
  }

  std::string describe(const TipDesc& tip) const {
    static const char* const names[] = {"flat punch", "sphere (parabola)", "sphere", "cone"};
    const bool cone = tip.indenter.profile == TipProfile::kCone, flat = tip.indenter.profile == TipProfile::kFlat;
    char text[320];
    std::snprintf(text, sizeof text, "piece %d: %s%s, %s %.5g, E* = %.5g Pa", static_cast<int>(index_),
                  names[static_cast<int>(tip.indenter.profile)], cone || flat ? "" : body_text().c_str(),
                  cone   ? "tan of half angle"
                  : flat ? "radius in mm"
                         : "effective radius in mm",
                  cone ? tip.indenter.tan_half_angle : 1e3 * tip.indenter.radius_m, tip.modulus_Pa);
    return text;
  }

  const SceneDesc& scene_;
  const PieceDesc& piece_;
  std::size_t index_;
};

void bake_pairs(const SceneDesc& scene, const std::vector<TipDesc>& tips, ImageContents& image,
                ResponseReport& report) {
  for (std::size_t i = 0; i < scene.pair.size(); ++i) {
    PairDesc pair = scene.pair[i];
    if (is_auto(pair.c_m_per_N) || is_auto(pair.h_ab_m_per_N2) || is_auto(pair.h_ba_m_per_N2)) {
      const auto place = [&](std::int32_t index) {
        const ToolPiece& piece = image.piece[static_cast<std::size_t>(index)];
        if (piece.point_count == 0)
          throw ConfigError(scene.source.where("tool.piece[" + std::to_string(index) + "].points") +
                            ": 0, so this piece touches nothing and no pair can be computed for it");
        return image.tool_point[static_cast<std::size_t>(piece.first_point)].position_tool_m;
      };
      const PairFit fit = fit_pair_far_field(scene, i, norm(place(pair.piece_a) - place(pair.piece_b)), tips);
      if (is_auto(pair.c_m_per_N)) pair.c_m_per_N = fit.c_m_per_N;
      if (is_auto(pair.h_ab_m_per_N2)) pair.h_ab_m_per_N2 = fit.h_ab_m_per_N2;
      if (is_auto(pair.h_ba_m_per_N2)) pair.h_ba_m_per_N2 = fit.h_ba_m_per_N2;
      char text[160];
      std::snprintf(text, sizeof text, "pieces %d and %d: c = %.5g m/N, h_ab = %.5g, h_ba = %.5g m/N2", pair.piece_a,
                    pair.piece_b, pair.c_m_per_N, pair.h_ab_m_per_N2, pair.h_ba_m_per_N2);
      report.tip.push_back(text);
    }
    image.tip_pair.push_back({pair.piece_a, pair.piece_b, pair.c_m_per_N, pair.h_ab_m_per_N2, pair.h_ba_m_per_N2});
  }
}

// What the law comes to at the end of its range, and how much of that is the layer's or the true sphere's doing.
std::string describe_law(const TipDesc& tip, const TipLaw& law) {
  const double half_space =
      tip_coefficient(tip.indenter, tip.modulus_Pa) * math::pow(law.depth_max_m, 0.5 * law.half_power);
  std::string layer = "half space";
  if (tip.layer.thickness_m > 0)
    layer = "layer of " + number_text(std::round(1e6 * tip.layer.thickness_m) / 1e3) +
            (tip.layer.base == LayerBase::kBonded ? " mm, bonded" : " mm, slipping");
  char text[256];
  std::snprintf(
      text, sizeof text,
      "         %s: %.4g N at %.4g mm, %.4g times the power law of a half space; c0 = %.4g mm/N, c1 = %.4g mm/N2",
      layer.c_str(), law.force_max_N, 1e3 * law.depth_max_m, law.force_max_N / half_space, 1e3 * law.c0_m_per_N,
      1e3 * law.c1_m_per_N2);
  return text;
}

// What boxes and hulls were taken apart into.
void describe_solids(const std::vector<PieceDesc>& pieces, ResponseReport& report) {
  const auto count = [&](PieceShape shape) {
    return std::to_string(
        std::ranges::count_if(pieces, [&](const PieceDesc& p) { return p.is_of_solid && p.shape == shape; }));
  };
  if (std::ranges::none_of(pieces, &PieceDesc::is_of_solid)) return;
  report.tip.push_back("boxes and hulls touch with " + count(PieceShape::kCapsule) + " edges, as lines, and " +
                       count(PieceShape::kBox) + " faces, as flat tips");
}

}  // namespace

void bake_response(const SceneDesc& scene, ImageContents& image, ResponseReport& report,
                   std::vector<std::string>& warnings) {
  const bool whole_tip = is_tip_law(scene.contact.law);
  if (!whole_tip && scene.contact.surface == ContactSurface::kFacets) return;
  image.corner_normal = corner_normals(scene.body, image.vertex_m, image.triangle);
  report.slack_m = largest_sag_m(image.corner_normal, image.vertex_m, image.triangle);
  // Of the margin within which the tick measures every point, what the smooth surface may take of it with half as much
  // again to spare (smooth_slack_m).
  constexpr double kMostSlack_m = 4e-4 / 1.5;
  if (!(report.slack_m < kMostSlack_m)) {
    const bool file = !scene.body.mesh.empty();
    throw ConfigError(scene.source.where(file ? "body.mesh" : "body.triangles") +
                      ": facets stand off the smooth surface by " +
                      number_text(std::round(1e5 * report.slack_m) / 100) + " mm; allowed 0.26 mm: " +
                      (file ? "mesh it finer, as by palpate mesh FILE --edge-mm LENGTH" : "use more triangles"));
  }
  image.params.smooth_slack_m = 1.5 * report.slack_m;
  if (!whole_tip) return;
  if (scene.contact.law == ContactLaw::kTable) {
    bake_table(scene, image, report, warnings);
    return;
  }
  std::vector<TipDesc> tips;
  std::vector<PieceDesc> pieces = scene.articulation == Articulation::kHand ? make_hand(scene.hand).piece : scene.piece;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    // A piece that touches nothing has a law all the same: every piece has a row in the image.
    if (pieces[i].points == 0 && is_auto(pieces[i].radius_m)) pieces[i].radius_m = scene.contact.max_depth_m;
    std::string line;
    tips.push_back(TipReader(scene, pieces[i], i).read(line));
    try {
      image.tip_law.push_back(make_tip_law(tips.back(), image.factor));
    } catch (const ConfigError& error) {
      throw ConfigError(scene.source.where("contact") + ": " + error.what());
    }
    if (pieces[i].is_of_solid) continue;
    report.tip.push_back(line);
    report.tip.push_back(describe_law(tips.back(), image.tip_law.back()));
  }
  describe_solids(pieces, report);
  bake_pairs(scene, tips, image, report);
}

}  // namespace palpate
