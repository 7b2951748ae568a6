// Which variant tuning keeps: a faster one only where repeated measurements leave no doubt.
#include "measure/tuned_choice.h"

#include <gtest/gtest.h>

namespace coppice {
namespace {

using Medians = std::vector<std::vector<double>>;

TEST(TunedChoice, AClearWinnerDisplacesTheRule) {
  const TunedChoice choice = choose_variant(Medians{{10, 11, 10.5}, {7, 9.9, 8}}, 0);
  EXPECT_EQ(choice.fastest, 1u);
  EXPECT_EQ(choice.chosen, 1u);
  EXPECT_TRUE(choice.sure);
}

TEST(TunedChoice, WhatNoiseDecidedDoesNot) {
  // Each is faster by its median, by far, but for one turn of either.
  for (const Medians& medians : {Medians{{10, 11, 6.9}, {7, 7, 7}}, Medians{{10, 10, 10}, {5, 10.5, 5}},
                                 Medians{{10, 10, 10}, {10, 5, 5}}}) {
    const TunedChoice choice = choose_variant(medians, 0);
    EXPECT_EQ(choice.fastest, 1u);
    EXPECT_EQ(choice.chosen, 0u);
    EXPECT_FALSE(choice.sure);
  }
}

TEST(TunedChoice, ASmallGainIsLeft) {
  EXPECT_EQ(choose_variant(Medians{{10, 10, 10}, {9.6, 9.6, 9.6}}, 0).chosen, 0u);
  EXPECT_EQ(choose_variant(Medians{{10, 10, 10}, {9.4, 9.4, 9.4}}, 0).chosen, 1u);
}

TEST(TunedChoice, TheRuleKeepsItsPlaceWhereItIsFastest) {
  const TunedChoice choice = choose_variant(Medians{{10, 12}, {9, 9.5}, {30, 1}}, 1);
  EXPECT_EQ(choice.chosen, 1u);
  EXPECT_TRUE(choice.sure);
}

TEST(TunedChoice, WhatCannotRunIsPassedOver) {
  const TunedChoice choice = choose_variant(Medians{{}, {10, 10}, {5, 5}, {}}, 1);
  EXPECT_EQ(choice.chosen, 2u);
}

}  // namespace
}  // namespace coppice
