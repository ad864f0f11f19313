// Keys that would do nothing beside the others: an error, since whoever writes a key means it to be felt. The rules are
// one table; those of a whole table or of a shape are in scene_check.cpp. Only keys that the file states are asked.
#include <algorithm>

#include "config/scene/config_error.h"
#include "config/scene/scene.h"
#include "config/tool/piece_card.h"

namespace palpate {

namespace {

bool is_response(const SceneDesc& s) { return s.contact.backend == Backend::kResponse; }
bool is_nodal(const SceneDesc& s) { return s.contact.backend == Backend::kNodal; }
bool is_tips(const SceneDesc& s) { return is_response(s) && is_tip_law(s.contact.law); }
bool is_points(const SceneDesc& s) { return is_response(s) && !is_tip_law(s.contact.law); }
bool is_hand(const SceneDesc& s) { return s.articulation == Articulation::kHand; }
bool has_skeleton(const SceneDesc& s) { return is_response(s) && s.skeleton.law != SkeletonLaw::kNone; }

bool has_several_tips(const SceneDesc& s) {
  return is_hand(s) || std::ranges::count_if(s.piece, [](const PieceDesc& p) { return p.points > 0; }) > 1;
}
// Whether regions feel one another through a far field. A region of tool points feels its own besides; a tip's own is
// in its law.
bool is_coupled(const SceneDesc& s) {
  return s.coupling.law == CouplingLaw::kCoupled && (is_points(s) || (is_tips(s) && has_several_tips(s)));
}
// Whether the baker presses the body by finite elements for the contact's law.
bool is_pressed(const SceneDesc& s) {
  if (!is_tips(s)) return false;
  if (s.contact.law == ContactLaw::kTable) return s.table.source == TableSource::kFem;
  const auto computed = [](const PairDesc& p) {
    return is_auto(p.c_m_per_N) || is_auto(p.h_ab_m_per_N2) || is_auto(p.h_ba_m_per_N2);
  };
  return is_auto(s.series.c0_m_per_N) || is_auto(s.series.c1_m_per_N2) || std::ranges::any_of(s.pair, computed);
}
// Whether the force of one press follows from E and nu.
bool knows_material(const SceneDesc& s) {
  return !is_response(s) || s.contact.law == ContactLaw::kHertz || s.contact.law == ContactLaw::kTool || is_pressed(s);
}
// A skeleton that the scene asks for is drawn by its beams, whose stiffness is E's, and temporal coupling carries
// forces over by them. The default one alone is no reason to state E.
bool draws_by_material(const SceneDesc& s) {
  return has_skeleton(s) && (s.source.has("skeleton") || carries_over(s.coupling.law));
}

bool modulus_works(const SceneDesc& s) { return knows_material(s) || is_coupled(s) || draws_by_material(s); }
// Mindlin's ratio of the tangential to the normal stiffness is nu's.
bool ratio_works(const SceneDesc& s) {
  return modulus_works(s) || s.friction.law == FrictionLaw::kMindlin || s.friction.law == FrictionLaw::kPresliding;
}

bool has_tip_of(const SceneDesc& s, TipProfile one, TipProfile other) {
  const auto is = [&](const PieceDesc& piece) {
    const auto tip = card_of(piece.shape).tip;
    if (piece.points == 0 || tip == nullptr) return false;
    const TipProfile profile = tip(piece).profile;
    return profile == one || profile == other;
  };
  return std::ranges::any_of(s.piece, is);
}
bool has_round_tip(const SceneDesc& s) {
  return is_hand(s) || has_tip_of(s, TipProfile::kSphere, TipProfile::kParabola) ||
         std::ranges::any_of(s.piece, [](const PieceDesc& p) { return p.shape == PieceShape::kCapsule; });
}
bool slides(const SceneDesc& s) { return s.friction.law != FrictionLaw::kNone; }
// Laws whose limit is K F^beta with K = mu_ref F_ref^(1 - beta).
bool has_power_limit(const SceneDesc& s) {
  return s.friction.law == FrictionLaw::kReturnMap || s.friction.law == FrictionLaw::kPaper ||
         s.friction.law == FrictionLaw::kMindlin;
}

bool rings(const SceneDesc& s) { return s.transient.amplitude_N_per_m_s > 0; }

struct EffectRule {
  const char* key;
  bool (*works)(const SceneDesc&);
  const char* because;
  const char* remedy;
};

constexpr const char* kNoSkeleton = "without a skeleton (skeleton.law = \"none\")";
constexpr const char* kNoFriction = "with friction.law = \"none\"";
constexpr const char* kNothingRings = "without contact.transient.amplitude_N_per_m_s, of which nothing rings";
constexpr const char* kStateAmplitude = "remove it or state the amplitude";
constexpr const char* kNoMaterial =
    "on the force: this scene's contact law is given by numbers of its own, and nothing else in it follows from the "
    "material";
constexpr const char* kTakeMaterial =
    "remove it, or take a law that follows from it: contact.law = \"tool\" or \"hertz\", contact.backend = \"elastic\"";
constexpr const char* kRemove = "remove it";

const EffectRule kRules[] = {
    {"body.material.youngs_modulus_Pa", modulus_works, kNoMaterial, kTakeMaterial},
    {"body.material.poisson_ratio", ratio_works, kNoMaterial, kTakeMaterial},
    {"body.material.relaxation_s", [](const SceneDesc& s) { return s.material.relaxation_share != Vec3{}; },
     "without body.material.relaxation_share, of which nothing relaxes", "remove it or state the shares"},
    {"body.material.legacy_paper_material",
     [](const SceneDesc& s) { return !s.material.legacy_paper_material || s.material.poisson_ratio > 0.5; },
     "with a poisson_ratio that is possible", kRemove},
    {"body.fixed", [](const SceneDesc& s) { return !is_response(s) || has_skeleton(s) || is_pressed(s); },
     "on a body that moves nowhere but under the tool: there is no skeleton, and its law does not know what holds it",
     "remove it, state a skeleton, or take contact.backend = \"elastic\""},
    {"skeleton.anchors", has_skeleton, kNoSkeleton, kRemove},
    {"skeleton.anchors_min", has_skeleton, kNoSkeleton, kRemove},
    {"skeleton.anchors_max", has_skeleton, kNoSkeleton, kRemove},
    {"skeleton.section_radius_mm", has_skeleton, kNoSkeleton, kRemove},
    {"shape.interpolation", has_skeleton, kNoSkeleton, kRemove},
    {"shape.tail", has_skeleton, kNoSkeleton, kRemove},
    {"shape.radius_mm", [](const SceneDesc& s) { return s.shape.neighbourhood != NeighbourhoodLaw::kNone; },
     "with shape.neighbourhood = \"none\", which draws no dent", kRemove},
    {"contact.cluster_distance_mm", [](const SceneDesc& s) { return s.contact.backend != Backend::kElastic; },
     "on an elastic body, where every tip is a region of its own", kRemove},
    {"contact.weight", [](const SceneDesc& s) { return !is_tips(s); },
     "with laws of whole tips, which have no tool points to weigh", kRemove},
    {"contact.reference_area_mm2",
     [](const SceneDesc& s) {
       const bool weighed = is_points(s) && s.contact.weight == ContactWeight::kWinkler;
       return weighed || (is_coupled(s) && is_auto(s.coupling.radius_m));
     },
     "where no force is weighed by it: it is of contact.weight = \"winkler\" and of a coupling.radius_mm that is auto",
     kRemove},
    {"coupling.radius_mm", is_coupled, "where no far field couples regions (coupling.law = \"coupled\", several tips)",
     kRemove},
    {"coupling.law", [](const SceneDesc& s) { return !carries_over(s.coupling.law) || has_skeleton(s); },
     "as \"temporal_paper\" or \"mutual_paper\" without a skeleton, which carries the forces over",
     "state a skeleton.law"},
    {"friction.mu_ref", slides, kNoFriction, kRemove},
    {"friction.k", slides, kNoFriction, kRemove},
    {"friction.beta", slides, kNoFriction, kRemove},
    {"friction.mu_dynamic", slides, kNoFriction, kRemove},
    {"friction.tangential",
     [](const SceneDesc& s) {
       return s.friction.law == FrictionLaw::kReturnMap || s.friction.law == FrictionLaw::kPaper;
     },
     "unless friction.law is \"return_map\" or \"paper\", which stick by the contact's own law", kRemove},
    {"friction.reference_force_N",
     [](const SceneDesc& s) {
       return has_power_limit(s) && s.friction.beta != 1 && (is_auto(s.friction.k) || is_auto(s.friction.mu_dynamic));
     },
     "where no coefficient depends on the force: it is of mu_ref with beta below 1, and of a mu_dynamic that is auto",
     kRemove},
    {"contact.tip.radius_mm",
     [](const SceneDesc& s) { return has_round_tip(s) || has_tip_of(s, TipProfile::kFlat, TipProfile::kFlat); },
     "on cones; it is of spheres and flat ends", kRemove},
    {"contact.tip.half_angle_deg",
     [](const SceneDesc& s) { return has_tip_of(s, TipProfile::kCone, TipProfile::kCone); }, "without a cone", kRemove},
    {"contact.tip.sphere", has_round_tip, "without a round tip", kRemove},
    {"contact.tip.body_radius_1_mm", has_round_tip, "without a round tip", kRemove},
    {"contact.tip.body_radius_2_mm", has_round_tip, "without a round tip", kRemove},
    {"contact.layer.base", [](const SceneDesc& s) { return s.layer.thickness_m > 0 || is_pressed(s); },
     "without contact.layer.thickness_mm", "remove it or state the thickness"},
    {"hand.grip_N", [](const SceneDesc& s) { return s.hand.closing == HandClosing::kBalanced; },
     "on fingers that close to a depth", "remove it or state hand.closing = \"balanced\""},
    {"device.grip_mm",
     [](const SceneDesc& s) { return s.device.holds == HeldPart::kBody || s.device.holds == HeldPart::kBoth; },
     "where no hand holds the body", "remove it or state device.holds"},
    {"contact.transient.frequency_Hz", rings, kNothingRings, kStateAmplitude},
    {"contact.transient.decay_per_s", rings, kNothingRings, kStateAmplitude},
    {"contact.nodal.friction_sweeps", [](const SceneDesc& s) { return !is_nodal(s) || slides(s); }, kNoFriction,
     kRemove},
};

// Keys that are stated and do nothing, with why.
std::vector<std::pair<std::string, std::string>> idle_keys(const SceneDesc& scene) {
  std::vector<std::pair<std::string, std::string>> idle;
  for (const EffectRule& rule : kRules) {
    const std::string first = std::string(rule.key) + "[0]";  // of a list of tables
    const std::string key = scene.source.has(first) ? first : rule.key;
    if (scene.source.has(key) && !rule.works(scene))
      idle.emplace_back(key, std::string("has no effect ") + rule.because + "; " + rule.remedy);
  }
  for (std::size_t i = 0; i < scene.piece.size(); ++i) {
    const std::string key = "tool.piece[" + std::to_string(i) + "].touches";
    if (scene.piece[i].points == 0 && scene.source.has(key))
      idle.emplace_back(key, "has no effect on a piece of points = 0, which never touches; remove it");
  }
  return idle;
}
}  // namespace

void check_effects(const SceneDesc& scene) {
  for (const auto& [key, why] : idle_keys(scene))
    if (!scene.source.is_overruled(key)) throw ConfigError(scene.source.where(key) + ": " + why);
}

std::vector<std::string> weak_keys(const SceneDesc& scene) {
  std::vector<std::string> said;
  for (const auto& [idle, why] : idle_keys(scene)) said.push_back(scene.source.where(idle) + ": " + why);
  const std::string key = "body.material.youngs_modulus_Pa";
  if (!scene.source.has(key) || !modulus_works(scene) || knows_material(scene)) return said;
  const std::string law = ChoiceOf<ContactLaw>::kWord[static_cast<std::int32_t>(scene.contact.law)];
  const bool drawn = draws_by_material(scene), coupled = is_coupled(scene);
  const bool carried = carries_over(scene.coupling.law);
  const std::string does = carried ? "the stiffness of the skeleton's beams"
                           : coupled && drawn
                               ? "how regions of contact give under one another, and how the drawn body does"
                           : coupled ? "how regions of contact give under one another"
                                     : "how the drawn body gives";
  said.push_back(
      scene.source.where(key) + ": the force of a press does not follow from it with contact.law = \"" + law +
      "\": it is only " + does +
      "; for a force that follows from the material take contact.law = \"tool\" or contact.backend = \"elastic\"");
  return said;
}

}  // namespace palpate
