// The loader ladder: every rung fires, every flipped bit and every truncation is refused, and a refused image leaves
// the model untouched.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "rt_core/image_check.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

ImageResult open(ImageBytes& image) {
  Model model;
  return open_image(image.bytes(), model);
}

TEST(Image, TinySceneOpens) {
  ImageBytes image = tiny_image();
  Model model;
  const ImageResult result = open_image(image.bytes(), model);
  ASSERT_EQ(result.error, ImageError::kNone) << describe(result.error) << ": " << result.field;
  EXPECT_STREQ(model.name, "tiny");
  EXPECT_EQ(model.triangle.size(), 4u);
  EXPECT_EQ(model.scene_hash, image.header().checksum);
  EXPECT_DOUBLE_EQ(model.params.k3_N_per_m3, 3e8);
}

TEST(Image, EveryFlippedBitIsRefused) {
  ImageBytes image = tiny_image();
  for (std::size_t byte = 0; byte < image.bytes().size(); ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      image.bytes()[byte] ^= std::byte(1 << bit);
      Model model;
      const ImageResult result = open_image(image.bytes(), model);
      EXPECT_NE(result.error, ImageError::kNone) << "byte " << byte << " bit " << bit;
      EXPECT_EQ(model.scene_hash, 0u);
      EXPECT_NE(result.field[0], '\0');
      image.bytes()[byte] ^= std::byte(1 << bit);
    }
  }
  EXPECT_EQ(open(image).error, ImageError::kNone);
}

TEST(Image, EveryTruncationIsRefused) {
  ImageBytes image = tiny_image();
  for (std::size_t length = 0; length < image.bytes().size(); ++length) {
    Model model;
    EXPECT_NE(open_image(image.bytes().first(length), model).error, ImageError::kNone) << length;
  }
}

TEST(Image, MisalignedBytesAreRefused) {
  ImageBytes image = tiny_image();
  Model model;
  EXPECT_EQ(open_image(image.bytes().subspan(8), model).error, ImageError::kMisaligned);
}

struct Damage {
  const char* what;
  ImageError error;
  const char* field;
  std::function<void(ImageBytes&)> apply;
};

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

// Each damage is sealed with a fitting checksum: the rung itself must catch it.
const Damage kDamages[] = {
    {"magic", ImageError::kMagic, "magic", [](ImageBytes& i) { i.header().magic += 1; }},
    {"version", ImageError::kVersion, "version", [](ImageBytes& i) { i.header().version += 1; }},
    {"real size", ImageError::kRealSize, "real_bytes", [](ImageBytes& i) { i.header().real_bytes = 4; }},
    {"layout", ImageError::kLayout, "layout_hash", [](ImageBytes& i) { i.header().layout_hash ^= 1; }},
    {"total", ImageError::kTotalSize, "total_bytes", [](ImageBytes& i) { i.header().total_bytes += 64; }},
    {"name", ImageError::kName, "name", [](ImageBytes& i) { std::memset(i.header().name, 'x', kNameBytes); }},
    {"negative size", ImageError::kSizeRange, "n_vertex", [](ImageBytes& i) { i.sizes().n_vertex = -4; }},
    {"huge size", ImageError::kSizeRange, "n_bvh", [](ImageBytes& i) { i.sizes().n_bvh = INT64_MAX; }},
    {"sizes do not add up", ImageError::kArrayBounds, "arrays", [](ImageBytes& i) { i.sizes().n_hull = 100; }},
    {"vertex not finite", ImageError::kNotFinite, "vertex_m",
     [](ImageBytes& i) { i.array<Vec3>(kVertex)[2].y = kNan; }},
    {"normal not unit", ImageError::kNotFinite, "vertex_normal", [](ImageBytes& i) { i.array<Vec3>(kNormal)[1] = {}; }},
    {"vertex index", ImageError::kCrossReference, "triangle.vertex",
     [](ImageBytes& i) { i.array<Triangle>(kTriangle)[3].vertex[1] = 4; }},
    {"adjacent index", ImageError::kCrossReference, "triangle.adjacent",
     [](ImageBytes& i) { i.array<Triangle>(kTriangle)[0].adjacent[2] = -1; }},
    {"cyclic tree", ImageError::kCrossReference, "bvh.child",
     [](ImageBytes& i) { i.array<BvhNode>(kBvh)->child[1] = 0; }},
    {"leaf too large", ImageError::kCrossReference, "bvh.count",
     [](ImageBytes& i) { i.array<BvhNode>(kBvh)->count[0] = 5; }},
    {"leaf outside", ImageError::kCrossReference, "bvh.child",
     [](ImageBytes& i) { i.array<BvhNode>(kBvh)->child[0] = ~1; }},
    {"triangle not covered", ImageError::kCrossReference, "bvh.coverage",
     [](ImageBytes& i) { i.array<BvhNode>(kBvh)->count[0] = 3; }},
    {"bounds inverted", ImageError::kNotFinite, "bvh.bounds",
     [](ImageBytes& i) { i.array<BvhNode>(kBvh)->lower_m[1][0] = 1.0f; }},
    {"bounds not finite", ImageError::kNotFinite, "bvh.bounds",
     [](ImageBytes& i) { i.array<BvhNode>(kBvh)->upper_m[2][0] = std::numeric_limits<float>::quiet_NaN(); }},
    {"anchor section", ImageError::kNotFinite, "anchor.section",
     [](ImageBytes& i) { i.array<Anchor>(kAnchor)->section_area_m2 = 0; }},
    {"anchor flag", ImageError::kCrossReference, "anchor.fixed",
     [](ImageBytes& i) { i.array<Anchor>(kAnchor)->fixed = 7; }},
    {"rbf not finite", ImageError::kNotFinite, "rbf_inverse",
     [](ImageBytes& i) { i.array<double>(kRbf)[3] = kInfinity; }},
    {"rbf tail", ImageError::kCrossReference, "n_rbf", [](ImageBytes& i) { i.params().rbf_tail = RbfTail::kLinear; }},
    {"mutual beams on baked ones", ImageError::kCrossReference, "anchor.mutual",
     [](ImageBytes& i) {
       i.params().coupling_law = CouplingLaw::kMutualPaper;
       i.params().skeleton_law = SkeletonLaw::kCircular;
     }},
    {"patches missing", ImageError::kCrossReference, "n_patch",
     [](ImageBytes& i) { i.params().shape_law = ShapeLaw::kDisplacementAnglePaper; }},
    {"beams missing", ImageError::kCrossReference, "n_beam_stiffness",
     [](ImageBytes& i) { i.params().skeleton_law = SkeletonLaw::kCircular; }},
    {"ratios missing", ImageError::kCrossReference, "n_beam_ratio",
     [](ImageBytes& i) { i.params().skeleton_law = SkeletonLaw::kCircularPaper; }},
    {"piece shape", ImageError::kCrossReference, "piece.shape",
     [](ImageBytes& i) { i.array<ToolPiece>(kPiece)->shape = static_cast<PieceShape>(ChoiceOf<PieceShape>::kCount); }},
    {"hull without vertices", ImageError::kCrossReference, "piece.hull_count",
     [](ImageBytes& i) { i.array<ToolPiece>(kPiece)->shape = PieceShape::kHull; }},
    {"faces that are not there", ImageError::kCrossReference, "piece.first_face",
     [](ImageBytes& i) { i.array<ToolPiece>(kPiece)->face_count = 4; }},
    {"planes without faces", ImageError::kCrossReference, "piece.plane_count",
     [](ImageBytes& i) { i.array<ToolPiece>(kPiece)->plane_count = 1; }},
    {"piece orientation", ImageError::kNotFinite, "piece.pose_tool",
     [](ImageBytes& i) { i.array<ToolPiece>(kPiece)->pose_tool.orientation.w = 2; }},
    {"piece margin", ImageError::kNotFinite, "piece.margin_m",
     [](ImageBytes& i) { i.array<ToolPiece>(kPiece)->margin_m = -1; }},
    {"piece neighbourhood", ImageError::kNotFinite, "piece.neighbourhood_m",
     [](ImageBytes& i) { i.array<ToolPiece>(kPiece)->neighbourhood_m = kNan; }},
    {"piece points", ImageError::kCrossReference, "piece.first_point",
     [](ImageBytes& i) { i.array<ToolPiece>(kPiece)->point_count = INT32_MAX; }},
    {"tool point piece", ImageError::kCrossReference, "tool_point.piece",
     [](ImageBytes& i) { i.array<ToolPoint>(kToolPoint)->piece = 1; }},
    {"tool point weight", ImageError::kNotFinite, "tool_point",
     [](ImageBytes& i) { i.array<ToolPoint>(kToolPoint)->weight = kNan; }},
    {"bound below what any tick takes", ImageError::kCombination, "stage_cost",
     [](ImageBytes& i) { i.array<StageCost>(k_stage_cost)[static_cast<int>(Stage::kFindRows)].instructions = 2000; }},
    {"bound above what the capacities allow", ImageError::kCombination, "stage_cost",
     [](ImageBytes& i) { i.array<StageCost>(k_stage_cost)[static_cast<int>(Stage::kFindRows)].instructions *= 1.01; }},
    {"bound of no number", ImageError::kCombination, "stage_cost",
     [](ImageBytes& i) { i.array<StageCost>(k_stage_cost)[0].instructions = kNan; }},
    {"stages missing", ImageError::kSizeRange, "n_stage", [](ImageBytes& i) { i.sizes().n_stage = 6; }},
    {"tool point place", ImageError::kNotFinite, "tool_point.position_tool_m",
     [](ImageBytes& i) { i.array<ToolPoint>(kToolPoint)->position_tool_m.x = 1e13; }},
};

TEST(Image, EachRungNamesItsField) {
  for (const Damage& damage : kDamages) {
    ImageBytes image = tiny_image();
    damage.apply(image);
    image.seal();
    const ImageResult result = open(image);
    EXPECT_EQ(result.error, damage.error) << damage.what << ": " << describe(result.error);
    EXPECT_STREQ(result.field, damage.field) << damage.what;
  }
}

// The same for the arrays of a finite-element body.
const Damage kNodalDamages[] = {
    {"no nodal vertices", ImageError::kCrossReference, "n_nodal",
     [](ImageBytes& i) { i.params().backend = Backend::kResponse; }},
    {"area", ImageError::kNotFinite, "nodal_vertex.area_m2",
     [](ImageBytes& i) { i.array<NodalVertex>(kNodalVertex)[1].area_m2 = 0; }},
    {"free flag", ImageError::kCrossReference, "nodal_vertex.is_free",
     [](ImageBytes& i) { i.array<NodalVertex>(kNodalVertex)[1].is_free = 2; }},
    {"compliance not finite", ImageError::kNotFinite, "compliance_f64",
     [](ImageBytes& i) { i.array<double>(kCompliance64)[100] = kNan; }},
    {"gauge not finite", ImageError::kNotFinite, "strain_gauge",
     [](ImageBytes& i) { i.array<float>(kStrainGauge)[71] = std::numeric_limits<float>::infinity(); }},
    {"no margin", ImageError::kCrossReference, "nodal parameters",
     [](ImageBytes& i) { i.params().contact_margin_m = 0; }},
    {"no wall", ImageError::kCrossReference, "nodal parameters", [](ImageBytes& i) { i.params().wall_N_per_m = 0; }},
};

TEST(Image, EachNodalRungNamesItsField) {
  Model model;
  ImageBytes whole = tiny_image(true);
  ASSERT_EQ(open_image(whole.bytes(), model).error, ImageError::kNone) << open_image(whole.bytes(), model).field;
  EXPECT_EQ(model.compliance_f64.size(), 144u);
  for (const Damage& damage : kNodalDamages) {
    ImageBytes image = tiny_image(true);
    damage.apply(image);
    image.seal();
    const ImageResult result = open(image);
    EXPECT_EQ(result.error, damage.error) << damage.what << ": " << describe(result.error);
    EXPECT_STREQ(result.field, damage.field) << damage.what;
  }
}

TEST(Image, FacesOfHullsAreLookedAt) {
  ImageBytes image = tiny_image();
  Model model;
  ASSERT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
  const HullFace whole{{0, 0, 1}, 0.01, {{0, 0, 0.01}, {0.01, 0, 0.01}, {0, 0.01, 0.01}}};
  HullFace lying = whole, far = whole, folded = whole;
  lying.normal = {};
  far.offset_m = kNan;
  folded.corner_m[1] = folded.corner_m[0];
  model.hull_face = {&whole, 1};
  EXPECT_EQ(check_arrays(model).error, ImageError::kNone);
  for (const HullFace& face : {lying, far, folded}) {
    model.hull_face = {&face, 1};
    EXPECT_EQ(check_arrays(model).error, ImageError::kNotFinite);
    EXPECT_STREQ(check_arrays(model).field, "hull_face");
  }
}

TEST(Image, NodalSceneWithoutItsArraysIsRefused) {
  ImageBytes image = tiny_image();
  image.params().backend = Backend::kNodal;
  image.params().friction_law = FrictionLaw::kNone;
  image.seal();
  EXPECT_EQ(open(image).error, ImageError::kCrossReference);
  EXPECT_STREQ(open(image).field, "n_nodal");
}

TEST(Image, EveryParameterIsRangeChecked) {
#define PALPATE_FIELD(type, name, unit, lowest, highest, meaning)                                            \
  for (const double value : {static_cast<double>(lowest) - 1.0, static_cast<double>(highest) + 1.0, kNan}) { \
    if (std::isnan(value) && !std::is_floating_point_v<type>) continue;                                      \
    ImageBytes image = tiny_image();                                                                         \
    image.params().name = static_cast<type>(value);                                                          \
    image.seal();                                                                                            \
    const ImageResult result = open(image);                                                                  \
    EXPECT_EQ(result.error, ImageError::kParamRange) << #name << " = " << value;                             \
    EXPECT_STREQ(result.field, #name);                                                                       \
  }
  PALPATE_MODEL_PARAMS(PALPATE_FIELD)
#undef PALPATE_FIELD
}

}  // namespace
}  // namespace palpate::test
