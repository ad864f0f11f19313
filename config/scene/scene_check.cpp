// Rules between keys: what one key's value allows or forbids for another.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "config/body/body_card.h"
#include "config/fem/material.h"
#include "config/scene/config_error.h"
#include "config/scene/hand_check.h"
#include "config/scene/scene.h"
#include "config/scene/schema.h"
#include "config/tool/piece_card.h"

namespace palpate {

namespace {

[[noreturn]] void fail(const SceneDesc& scene, const std::string& key, const std::string& what) {
  throw ConfigError(scene.source.where(key) + ": " + what);
}

void refuse_piece(const SceneDesc& scene, const std::string& label, const Refusal& refusal) {
  if (refusal.key != nullptr) fail(scene, label + "." + refusal.key, refusal.what);
}

// Refuses the keys of `all` that are present in the file but not in `used`: they would have no effect.
void check_effect(const SceneDesc& scene, const std::string& table, std::initializer_list<const char*> all,
                  std::initializer_list<const char*> used, const std::string& because) {
  for (const char* key : all) {
    const bool is_used = std::any_of(used.begin(), used.end(), [&](const char* u) { return std::string(u) == key; });
    if (!is_used && scene.source.has(table + "." + key))
      fail(scene, table + "." + key, "has no effect " + because + "; remove it");
  }
}

// Every key of [body] that some shape takes, beside the shape's own.
void check_body_keys(const SceneDesc& scene) {
  const BodyCard& card = card_of(scene.body.shape);
  for (std::int32_t i = 0; i < ChoiceOf<BodyShape>::kCount; ++i)
    for (const CardKey& other : card_of(static_cast<BodyShape>(i)).keys) {
      const bool taken =
          std::ranges::any_of(card.keys, [&](const CardKey& own) { return std::string(own.key) == other.key; });
      if (!taken && scene.source.has(std::string("body.") + other.key))
        fail(scene, std::string("body.") + other.key,
             "has no effect with shape = \"" + std::string(word_of(scene.body.shape)) + "\"; remove it");
    }
  if (card.check == nullptr) return;
  const Refusal refusal = card.check(scene.body);
  if (refusal.key != nullptr) fail(scene, std::string("body.") + refusal.key, refusal.what);
}

void check_skeleton(const SceneDesc& scene) {
  const SkeletonLaw law = scene.skeleton.law;
  const bool circular = law == SkeletonLaw::kCircular || law == SkeletonLaw::kCircularPaper;
  if (circular && scene.coupling.law == CouplingLaw::kMutualPaper)
    fail(scene, "coupling.law",
         "\"mutual_paper\" draws straight beams from contact to contact, and skeleton.law = \"" +
             std::string(word_of(law)) +
             "\" has none; allowed none, coupled, temporal_paper, or a straight skeleton.law");
  if (circular)
    return check_effect(scene, "skeleton", {"section_radius_mm"}, {},
                        "with circular beams, whose section is beam_width_mm x beam_thickness_mm");
  check_effect(scene, "skeleton", {"beam_width_mm", "beam_thickness_mm", "beam_allowance_mm"}, {},
               "unless skeleton.law is \"circular\" or \"circular_paper\"");
}

void check_relaxation(const SceneDesc& scene) {
  const Vec3 share = scene.material.relaxation_share;
  if (scene.contact.backend == Backend::kNodal)
    check_effect(scene, "body.material", {"lost_share"}, {}, "with contact.backend = \"nodal\"");
  if (share == Vec3{}) return;
  if (!(share.x > 0))
    fail(scene, "body.material.relaxation_share", "the first term is 0; begin with the first and end with zeros");
  if (!(share.x + share.y + share.z < 0.95))
    fail(scene, "body.material.relaxation_share",
         number_text(share.x + share.y + share.z) + " of the force would relax; allowed below 0.95 together");
  if (scene.contact.backend == Backend::kNodal)
    fail(scene, "body.material.relaxation_share",
         "has no effect with contact.backend = \"nodal\"; remove it or take \"elastic\"");
}

void check_body(const SceneDesc& scene) {
  check_body_keys(scene);
  check_relaxation(scene);
  check_skeleton(scene);
  const double nu = scene.material.poisson_ratio;
  if (nu > 0.5 && !(scene.material.legacy_paper_material && nu == 1.0))
    fail(scene, "body.material.poisson_ratio",
         number_text(nu) +
             " is thermodynamically impossible; allowed -0.999 to 0.5. For the printed 1.0 of Cui & Xiao 2008 set "
             "body.material.legacy_paper_material = true");
  if (scene.skeleton.anchors_min > scene.skeleton.anchors_max)
    fail(scene, "skeleton.anchors_min",
         std::to_string(scene.skeleton.anchors_min) +
             " is larger than skeleton.anchors_max = " + std::to_string(scene.skeleton.anchors_max) + "; lower it");
}

// Tables that the baker presses itself: the layer, if the scene states one, is the body's own height.
void check_presses(const SceneDesc& scene) {
  for (const char* key : {"file", "smooth"})
    if (scene.source.has(std::string("contact.table.") + key))
      fail(scene, std::string("contact.table.") + key,
           "has no effect with contact.table.source = \"fem\"; remove it or set source = \"file\"");
  const double stated = scene.layer.thickness_m;
  const auto layer_m = card_of(scene.body.shape).layer_m;
  const double height = layer_m != nullptr ? layer_m(scene.body) : 0;
  if (stated > 0 && layer_m == nullptr)
    fail(scene, "contact.layer.thickness_mm",
         "has no effect on this body with contact.table.source = \"fem\"; remove it");
  const auto in_mm = [](double length_m) { return number_text(std::round(1e9 * length_m) / 1e6) + " mm"; };
  if (stated > 0 && !(std::abs(stated - height) <= 1e-9))
    fail(scene, "contact.layer.thickness_mm",
         in_mm(stated) + ", but the body that contact.table.source = \"fem\" presses is " + in_mm(height) +
             " high; make them equal");
}

void check_contact(const SceneDesc& scene) {
  const auto unused_table = [&](const char* name, ContactLaw law, const char* law_name) {
    const std::string table = std::string("contact.") + name;
    if (scene.contact.law != law && scene.source.has(table) && !scene.source.is_overruled(table))
      fail(scene, table,
           std::string("has no effect unless contact.law = \"") + law_name + "\"; set it or remove the table");
  };
  unused_table("duffing", ContactLaw::kDuffing, "duffing");
  unused_table("cubic", ContactLaw::kCubic, "cubic");
  unused_table("hertz", ContactLaw::kHertz, "hertz");
  const bool pressed = scene.contact.law == ContactLaw::kTable && scene.table.source == TableSource::kFem;
  for (const char* table : {"tip", "layer", "series", "pair", "pair[0]"})
    if (!(pressed && std::string(table) == "layer")) unused_table(table, ContactLaw::kTool, "tool");
  unused_table("table", ContactLaw::kTable, "table");
  for (std::size_t i = 0; i < scene.piece.size(); ++i)
    if (!scene.piece[i].table_file.empty() && (scene.contact.law != ContactLaw::kTable || pressed))
      fail(scene, "tool.piece[" + std::to_string(i) + "].table_file",
           "has no effect unless contact.law = \"table\" reads its curves from files; remove it");
  if (pressed)
    check_presses(scene);
  else if (scene.contact.law == ContactLaw::kTable && scene.table.file.empty())
    fail(scene, "contact.table.file",
         "missing; law = \"table\" needs the path of a CSV file, or contact.table.source = \"fem\"");
  if (scene.contact.law == ContactLaw::kCubic && !(scene.cubic.k1_N_per_m > 0 || scene.cubic.k3_N_per_m3 > 0))
    fail(scene, "contact.cubic", "k1_N_per_m and k3_N_per_m3 are both 0: no force; set at least one");
  if (scene.contact.law == ContactLaw::kDuffing && !(scene.duffing.omega0 > 0 || scene.duffing.beta0sq_eps > 0))
    fail(scene, "contact.duffing", "omega0 and beta0sq_eps are both 0: no force; set at least one");
  if (!is_auto(scene.friction.mu_ref) && !is_auto(scene.friction.k))
    fail(scene, "friction.k", "both k and mu_ref are given, and each determines the other; keep one");
}

// Laws of whole tips: what friction, coupling and the pieces must be.
void check_tips(const SceneDesc& scene) {
  if (!is_tip_law(scene.contact.law)) return;
  check_effect(scene, "contact", {"surface"}, {}, "with laws of whole tips, which always have the smooth surface");
  check_effect(scene, "contact", {"equivalent_point"}, {},
               "with laws of whole tips, each of which touches at one point");
  if (carries_over(scene.coupling.law))
    fail(scene, "coupling.law",
         "\"" + std::string(word_of(scene.coupling.law)) +
             "\" needs tool points with cubic springs; allowed none, coupled");
  for (std::size_t i = 0; i < scene.piece.size(); ++i) {
    const PieceDesc& piece = scene.piece[i];
    const std::string label = "tool.piece[" + std::to_string(i) + "]";
    if (piece.points == 0 || piece.is_of_solid) continue;
    const PieceCard& card = card_of(piece.shape);
    if (scene.contact.backend == Backend::kElastic &&
        (piece.shape == PieceShape::kBox || piece.shape == PieceShape::kHull))
      fail(scene, label + ".points",
           std::to_string(piece.points) + "; an elastic body is touched by all of a " +
               std::string(word_of(piece.shape)) + ": remove it, or set points = 0 where it does not touch");
    if (card.tip == nullptr)
      fail(scene, label + ".shape",
           "a " + std::string(word_of(piece.shape)) + " has no tip law; allowed " +
               shapes_where([](PieceShape shape) { return card_of(shape).tip != nullptr; }) + ", or points = 0");
    const bool side =
        card.has_side_tip && scene.contact.backend == Backend::kElastic && piece.touches == TouchingEnd::kAll;
    if (card.check_tip != nullptr && !side) refuse_piece(scene, label, card.check_tip(piece));
  }
  const auto pieces = static_cast<std::int32_t>(scene.piece.size());
  for (std::size_t i = 0; i < scene.pair.size(); ++i) {
    const PairDesc& pair = scene.pair[i];
    if (!(pair.piece_a < pieces && pair.piece_b < pieces && pair.piece_a != pair.piece_b))
      fail(scene, "contact.pair[" + std::to_string(i) + "].piece_a",
           "a pair needs two different pieces; allowed 0 to " + std::to_string(pieces - 1));
  }
  if (scene.pair.size() > static_cast<std::size_t>(kMaxTipPairs))
    fail(scene, "contact.pair",
         std::to_string(scene.pair.size()) + " pairs; allowed up to " + std::to_string(kMaxTipPairs));
}

// The laws that the scene's method of contact takes: the column of their table.
void check_friction_method(const SceneDesc& scene) {
  const bool nodes = scene.contact.backend == Backend::kNodal, elastic = scene.contact.backend == Backend::kElastic,
             tips = !nodes && is_tip_law(scene.contact.law);
  const unsigned method = nodes ? kOfNodes : elastic ? kOfElastic : tips ? kOfTips : kOfPoints;
  if ((methods_of(scene.friction.law) & method) != 0) return;
  std::string allowed;
  for (std::int32_t i = 0; i < ChoiceOf<FrictionLaw>::kCount; ++i)
    if ((methods_of(static_cast<FrictionLaw>(i)) & method) != 0)
      allowed += (allowed.empty() ? "" : ", ") + std::string(ChoiceOf<FrictionLaw>::kWord[i]);
  fail(scene, "friction.law",
       "\"" + std::string(word_of(scene.friction.law)) + "\" is not for " +
           (nodes     ? "contact.backend = \"nodal\""
            : elastic ? "contact.backend = \"elastic\""
            : tips    ? "contact.law = \"tool\" and \"table\", which have no springs of tool points"
                      : "tool points, contact.backend = \"response\"") +
           "; allowed " + allowed);
}

void check_friction(const SceneDesc& scene) {
  check_friction_method(scene);
  if (is_presliding(scene.friction.law))
    for (const char* key : {"beta", "mu_dynamic", "k", "tangential", "reference_force_N"})
      if (scene.source.has(std::string("friction.") + key))
        fail(scene, std::string("friction.") + key,
             "has no effect with the presliding laws, whose limit is mu_ref times the normal force; remove it");
  if (scene.friction.law != FrictionLaw::kPreslidingPaper && scene.source.has("friction.slip_distance_mm"))
    fail(scene, "friction.slip_distance_mm", "has no effect unless friction.law = \"presliding_paper\"; remove it");
}

// Order of the finite elements: where it is mixed, the zone of the quadratic ones.
void check_order(const SceneDesc& scene) {
  if (scene.fem.order != FemOrder::kMixed)
    return check_effect(scene, "body.fem", {"zone_from_mm", "zone_to_mm", "zone_layers"}, {},
                        "unless body.fem.order = \"mixed\"");
  for (const char* key : {"body.fem.zone_from_mm", "body.fem.zone_to_mm"})
    if (!scene.source.has(key))
      fail(scene, key, "missing; order = \"mixed\" needs both corners of the box in which elements are quadratic");
  const Vec3 from = scene.fem.zone_from_m, to = scene.fem.zone_to_m;
  if (!(from.x < to.x && from.y < to.y && from.z < to.z))
    fail(scene, "body.fem.zone_to_mm", "must be greater than zone_from_mm along x, y and z; exchange the corners");
  if (scene.material.poisson_ratio > kMeanDilatationAbove)
    fail(scene, "body.fem.order",
         "\"mixed\" needs body.material.poisson_ratio of at most 0.49, where linear elements lock; use \"quadratic\"");
}

void check_vertices(const SceneDesc& scene, const FixedDesc& entry, const std::string& table,
                    const std::string& because) {
  if (entry.region != FixedRegion::kVertices)
    return check_effect(scene, table, {"vertices", "vertices_file"}, {}, because);
  if (entry.vertices.empty() == entry.vertices_file.empty())
    fail(scene, table + ".vertices",
         entry.vertices.empty() ? "missing; give the numbers here, or a text file of them as vertices_file"
                                : "given twice; remove it or vertices_file");
}

// What only finite elements can be held by, and what an elastic body alone.
void check_bed(const SceneDesc& scene, const FixedDesc& entry, const std::string& table) {
  if (scene.contact.backend == Backend::kResponse) {
    check_effect(scene, table, {"holds"}, {}, "with tool points, whose anchors stand still or do not");
    if (entry.region == FixedRegion::kPatch || entry.region == FixedRegion::kVertices)
      fail(scene, table + ".region",
           "\"" + std::string(word_of(entry.region)) +
               "\" is of finite elements; with tool points take a ball or a box");
  }
  if (scene.contact.backend != Backend::kElastic)
    check_effect(scene, table, {"stiffness_N_per_m3"}, {}, "unless contact.backend = \"elastic\"");
  if (entry.holds == HeldComponents::kNormal && is_auto(entry.stiffness_N_per_m3))
    fail(scene, table + ".holds",
         "\"normal\" is of elastic beds; add stiffness_N_per_m3 (a stiff plate: a thousand times E over the body's "
         "size), or hold a component");
}

// Keys of a table whose region is `word`: all there when that is `of`, none otherwise.
void needs_keys(const SceneDesc& scene, const std::string& table, std::initializer_list<const char*> keys,
                const std::string& word, const std::string& of) {
  if (word != of) return check_effect(scene, table, keys, {}, "with region = \"" + word + "\"");
  for (const char* key : keys)
    if (!scene.source.has(table + "." + key)) fail(scene, table, std::string(key) + ": missing; a " + of + " needs it");
}
void check_corners(const SceneDesc& scene, const std::string& table, Vec3 from, Vec3 to) {
  if (!(from.x < to.x && from.y < to.y && from.z < to.z))
    fail(scene, table + ".to_mm", "must be greater than from_mm along x, y and z; exchange the corners");
}

// Each entry of body.fixed has the keys of its region and no other.
void check_fixed(const SceneDesc& scene) {
  for (std::size_t i = 0; i < scene.fixed.size(); ++i) {
    const FixedDesc& entry = scene.fixed[i];
    const std::string numbered = "body.fixed[" + std::to_string(i) + "]";
    const std::string table = scene.source.has(numbered) ? numbered : "body.fixed";
    const FixedRegion region = entry.region;
    const std::string word = word_of(region), because = "with region = \"" + word + "\"";
    if (region != FixedRegion::kBase) check_effect(scene, table, {"base_height_mm"}, {}, because);
    needs_keys(scene, table, {"from_mm", "to_mm"}, word, word_of(FixedRegion::kBox));
    needs_keys(scene, table, {"centre_mm", "radius_mm"}, word,
               word_of(region == FixedRegion::kPatch ? region : FixedRegion::kBall));
    check_vertices(scene, entry, table, because);
    if (region == FixedRegion::kBox) check_corners(scene, table, entry.from_m, entry.to_m);
    check_bed(scene, entry, table);
  }
}

// Each entry of body.material_region has the keys of its shape and no other.
void check_material_regions(const SceneDesc& scene) {
  for (std::size_t i = 0; i < scene.material_region.size(); ++i) {
    const MaterialRegionDesc& entry = scene.material_region[i];
    const std::string table = "body.material_region[" + std::to_string(i) + "]";
    if (scene.contact.backend != Backend::kElastic)
      fail(scene, table, "has no effect unless contact.backend = \"elastic\"; remove it or set that");
    needs_keys(scene, table, {"from_mm", "to_mm"}, word_of(entry.region), word_of(MaterialShape::kBox));
    needs_keys(scene, table, {"centre_mm", "radius_mm"}, word_of(entry.region), word_of(MaterialShape::kBall));
    needs_keys(scene, table, {"group"}, word_of(entry.region), word_of(MaterialShape::kGroup));
    if (entry.region == MaterialShape::kBox) check_corners(scene, table, entry.from_m, entry.to_m);
  }
}

void check_no_table(const SceneDesc& scene, const char* name, const char* because) {
  if (scene.source.has(name)) fail(scene, name, std::string("has no effect ") + because + "; remove the table");
}

// Elements and supports of both bodies that have them.
void check_elements(const SceneDesc& scene) {
  if (scene.material.poisson_ratio >= 0.5)
    fail(scene, "body.material.poisson_ratio",
         number_text(scene.material.poisson_ratio) + "; finite elements need less than 0.5: use 0.4999 or below");
  if (scene.body.shape != BodyShape::kClip)
    check_effect(scene, "body.fem", {"level"}, {}, "unless body.shape = \"clip\"");
  if (card_of(scene.body.shape).own_tets)
    check_effect(scene, "body.fem", {"edge_mm"}, {}, "with a body that brings its own mesh");
  if (card_of(scene.body.shape).supports != nullptr)
    check_no_table(scene, "body.fixed", "for a body that says what is held");
}

// The elastic back-end makes its tips' laws and what couples them itself.
void check_elastic(const SceneDesc& scene) {
  constexpr const char* kBecause = "with contact.backend = \"elastic\"";
  if (scene.contact.law != ContactLaw::kTool)
    fail(scene, "contact.law",
         std::string("has no effect ") + kBecause + ", whose tips have the law of their shape; remove it");
  for (const char* table : {"skeleton", "shape", "coupling", "contact.layer", "contact.series", "contact.pair",
                            "contact.pair[0]", "contact.nodal"})
    check_no_table(scene, table, kBecause);
  check_effect(scene, "contact", {"weight", "equivalent_point", "surface", "reference_area_mm2"}, {}, kBecause);
  check_effect(scene, "contact.tip", {"body_radius_1_mm", "body_radius_2_mm"}, {}, kBecause);
  check_effect(scene, "hand", {"points_per_part"}, {}, kBecause);
  check_effect(scene, "body.fem", {"order", "zone_from_mm", "zone_to_mm", "zone_layers", "precision", "strain_gauges"},
               {}, kBecause);
  if (scene.elastic.check_presses == 0 || (scene.elastic.check_presses < 0 && scene.elastic.soft > 0))
    check_effect(scene, "body.elastic", {"check_error"}, {}, "without check presses (body.elastic.check_presses)");
  check_elements(scene);
}

// The nodal back-end has no tool-point law, no skeleton and no shape functions; the response no finite elements.
void check_backend(const SceneDesc& scene) {
  const bool nodal = scene.contact.backend == Backend::kNodal, elastic = scene.contact.backend == Backend::kElastic;
  const auto no_table = [&](const char* name, const char* because) { check_no_table(scene, name, because); };
  if (!elastic) no_table("body.elastic", "unless contact.backend = \"elastic\"");
  if (elastic) return check_elastic(scene);
  if (!nodal) {
    no_table("body.fem", "unless contact.backend = \"nodal\" or \"elastic\"");
    no_table("contact.nodal", "unless contact.backend = \"nodal\"");
    return;
  }
  for (const char* table : {"skeleton", "shape", "coupling", "contact.duffing", "contact.cubic", "contact.hertz"})
    no_table(table, "with contact.backend = \"nodal\"");
  check_effect(scene, "contact", {"law", "weight", "equivalent_point", "surface", "reference_area_mm2", "max_depth_mm"},
               {}, "with contact.backend = \"nodal\"");
  check_effect(scene, "friction", {"tangential", "reference_force_N", "k", "beta", "mu_dynamic"}, {},
               "with law = \"coulomb\" or \"none\"");
  check_elements(scene);
  check_order(scene);
  if (scene.nodal.solver == NodalSolver::kPivoting)
    check_effect(scene, "contact.nodal", {"sweeps"}, {}, "with solver = \"pivoting\"");
}

void check_transient(const SceneDesc& scene) {
  const TransientDesc& t = scene.transient;
  if (!(t.amplitude_N_per_m_s > 0)) return;
  for (const auto& [key, value] : {std::pair{"frequency_Hz", t.frequency_Hz}, {"decay_per_s", t.decay_per_s}})
    if (!(value > 0))
      fail(scene, std::string("contact.transient.") + key,
           "must be stated beside amplitude_N_per_m_s: what rings, how often and for how long");
  const double most_Hz = 0.4 / scene.device.period_s;
  if (!(t.frequency_Hz <= most_Hz))
    fail(scene, "contact.transient.frequency_Hz",
         number_text(t.frequency_Hz) + " is too fast for samples every " + number_text(1e3 * scene.device.period_s) +
             " ms; at most " + number_text(most_Hz));
}

// What error_target is a choice of: the models that follow from the material.
void check_error_target(const SceneDesc& scene) {
  if (scene.error_target.empty() || scene.error_target == "none") return;
  const double share = error_target_share(scene);
  if (is_auto(share) || !(share >= 1e-3 && share <= 1))
    fail(scene, "error_target", "'" + scene.error_target + "' is no error; allowed \"0.1 %\" to \"100 %\", \"none\"");
  if (scene.source.has("contact.law") || scene.contact.backend != Backend::kElastic)
    fail(scene, "error_target",
         "has no effect where contact.law or contact.backend states the model; leave both out, or state "
         "contact.backend = \"elastic\"");
  if (scene.source.has("body.elastic.check_error"))
    fail(scene, "body.elastic.check_error", "has no effect beside error_target, which says the same; remove one");
  if (scene.elastic.check_presses == 0)
    fail(scene, "body.elastic.check_presses", "0, but error_target is judged by presses; allowed 1 to 16");
}

bool gives(const PieceDesc& piece, const std::string& key) {
  if (key == "radius_mm") return !is_auto(piece.radius_m);
  if (key == "length_mm") return !is_auto(piece.length_m);
  if (key == "size_mm") return !is_auto(piece.size_m.x);
  if (key == "vertices_mm") return !piece.vertices_m.empty();
  return !is_auto(piece.margin_m);
}

void check_piece(const SceneDesc& scene, const PieceDesc& piece, const std::string& label) {
  const PieceCard& card = card_of(piece.shape);
  for (const std::string key : {"radius_mm", "length_mm", "size_mm", "vertices_mm"}) {
    const bool needed = std::ranges::any_of(card.sizes, [&](const CardKey& size) { return size.key == key; });
    if (needed && !gives(piece, key)) fail(scene, label + "." + key, "missing; this shape needs it");
    if (!needed && gives(piece, key)) fail(scene, label + "." + key, "has no effect for this shape; remove it");
  }
  if (card.margin == nullptr && gives(piece, "margin_mm"))
    fail(scene, label + ".margin_mm", "has no effect for this shape; remove it");
  if (card.check != nullptr) refuse_piece(scene, label, card.check(piece));
  if (piece.touches != TouchingEnd::kAll && !card.has_ends)
    fail(scene, label + ".touches", "this shape has no end face; remove it");
}

void check_tool(const SceneDesc& scene) {
  const auto count = static_cast<std::int32_t>(scene.piece.size());
  if (scene.articulation == Articulation::kHand) {
    if (count > 0) fail(scene, "tool.piece", "the hand is made of its own pieces; remove [[tool.piece]] or [hand]");
    return;
  }
  if (count < 1 || count > kMaxPieces)
    fail(scene, "tool.piece",
         std::to_string(count) + " pieces; allowed 1 to " + std::to_string(kMaxPieces) + ": write [[tool.piece]]");
  std::int32_t points = 0;
  for (std::int32_t i = 0; i < count; ++i) {
    const std::string label = "tool.piece[" + std::to_string(i) + "]";
    const PieceDesc& piece = scene.piece[static_cast<std::size_t>(i)];
    if (!piece.is_of_solid) check_piece(scene, piece, label);
    points += piece.points;
  }
  if (points < 1 || points > kMaxToolPoints)
    fail(scene, "tool.piece",
         std::to_string(points) + " tool points in all; allowed 1 to " + std::to_string(kMaxToolPoints) +
             ": change the pieces' points");
}

void check_articulation(const SceneDesc& scene) {
  std::vector<Vec3> slides;
  for (std::size_t i = 0; i < scene.piece.size(); ++i) {
    const Vec3 slide = scene.piece[i].slide_m;
    if (!(norm(slide) > 0)) continue;
    const std::string key = "tool.piece[" + std::to_string(i) + "].slide_mm";
    if (scene.articulation != Articulation::kGripper)
      fail(scene, key, "has no effect without a [gripper] table; add [gripper] or remove it");
    if (std::ranges::find(slides, slide) == slides.end()) slides.push_back(slide);
    if (slides.size() > kMaxJoints)
      fail(scene, key,
           "one jaw too many; allowed " + std::to_string(kMaxJoints) +
               ": give pieces of one jaw the same "
               "slide_mm");
  }
  if (scene.source.has("hand") && scene.source.has("gripper"))
    fail(scene, "gripper", "a tool is a hand or a gripper; remove [hand] or [gripper]");
  if (scene.articulation == Articulation::kGripper && slides.empty())
    fail(scene, "gripper", "no piece moves; give the pieces of at least one jaw a slide_mm");
}

}  // namespace

double error_target_share(const SceneDesc& scene) {
  const std::string& text = scene.error_target;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  while (*end == ' ') ++end;
  return end != text.c_str() && std::string(end) == "%" ? 0.01 * value : kAuto;
}

void check_scene(const SceneDesc& scene) {
  check_error_target(scene);
  check_body(scene);
  check_fixed(scene);
  check_material_regions(scene);
  check_contact(scene);
  check_friction(scene);
  check_backend(scene);
  check_transient(scene);
  check_tips(scene);
  check_tool(scene);
  check_articulation(scene);
  check_hands(scene);
  check_paths(scene);
}

}  // namespace palpate
