// Enumerations made of tables: words, order and range.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "rt_core/laws.h"

namespace palpate {
namespace {

template <class Enum>
void expect_sound() {
  std::set<std::string> words;
  for (std::int32_t i = 0; i < ChoiceOf<Enum>::kCount; ++i) {
    EXPECT_TRUE(is_choice(static_cast<Enum>(i)));
    EXPECT_TRUE(words.insert(word_of(static_cast<Enum>(i))).second) << "twice: " << word_of(static_cast<Enum>(i));
  }
  EXPECT_FALSE(is_choice(static_cast<Enum>(-1)));
  EXPECT_FALSE(is_choice(static_cast<Enum>(ChoiceOf<Enum>::kCount)));
}

TEST(Choice, WordsAreUniqueAndTheRangeIsTheTable) {
  expect_sound<ContactWeight>();
  expect_sound<FrictionLaw>();
  expect_sound<SkeletonLaw>();
  expect_sound<NeighbourhoodLaw>();
  expect_sound<PieceShape>();
  EXPECT_STREQ(word_of(FrictionLaw::kPreslidingPaper), "presliding_paper");
  EXPECT_STREQ(word_of(SkeletonLaw::kCircularPaper), "circular_paper");
  EXPECT_EQ(last_choice<FrictionLaw>(), FrictionLaw::kPreslidingPaper);
}

// docs/models.md: who takes which law.
TEST(Choice, FrictionLawsNameTheirMethods) {
  for (std::int32_t i = 0; i < ChoiceOf<FrictionLaw>::kCount; ++i)
    EXPECT_NE(methods_of(static_cast<FrictionLaw>(i)), 0u) << word_of(static_cast<FrictionLaw>(i));
  EXPECT_EQ(methods_of(FrictionLaw::kNone), kOfPoints | kOfTips | kOfNodes | kOfElastic);
  EXPECT_EQ(methods_of(FrictionLaw::kCoulomb), kOfNodes);
  EXPECT_EQ(methods_of(FrictionLaw::kReturnMap), kOfPoints);
  EXPECT_TRUE(is_presliding(FrictionLaw::kPresliding) && is_presliding(FrictionLaw::kPreslidingPaper));
  EXPECT_FALSE(is_presliding(FrictionLaw::kCoulomb));
}

}  // namespace
}  // namespace palpate
