#include "pipelines/spin/types/products.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace spindrift::products_test {

TEST(SpinProducts, QuantitiesHaveTheNamesOfTheArchive) {
  using enum SpinQuantity;
  const std::array<std::pair<SpinQuantity, std::string_view>, kSpinQuantities> names = {
      {{Period, "period"},
       {SunAngle, "sun_angle"},
       {NorthChord, "north_chord"},
       {SouthChord, "south_chord"},
       {NorthDihedral, "north_dihedral"},
       {SouthDihedral, "south_dihedral"},
       {MixedAzimuth, "mixed_azimuth"}}};
  for (const auto& [quantity, name] : names) {
    EXPECT_EQ(name_of(quantity), name);
  }
}

TEST(SpinProducts, AFailedTestIsNamedAfterItsQuantity) {
  for (std::size_t i = 0; i < kSpinQuantities; ++i) {
    const auto quantity = static_cast<SpinQuantity>(i);
    EXPECT_EQ(name_of(rejection_of(quantity)), name_of(quantity));
  }
}

TEST(SpinProducts, OtherRejectionsSayWhatWasWrong) {
  EXPECT_EQ(name_of(Rejection::Unassociated), "unassociated");
  EXPECT_EQ(name_of(Rejection::Late), "late");
  EXPECT_EQ(name_of(Rejection::Geometry), "geometry");
  EXPECT_EQ(name_of(Rejection::NoOrbit), "no_orbit");
}

TEST(SpinProducts, ResolutionsHaveTheNamesOfTheArchive) {
  EXPECT_EQ(name_of(Resolution::Geometry), "GEOMETRY");
  EXPECT_EQ(name_of(Resolution::Constraint), "CONSTRAINT");
  EXPECT_EQ(name_of(Resolution::Prior), "PRIOR");
  EXPECT_EQ(name_of(Resolution::Dispersion), "DISPERSION");
  EXPECT_EQ(name_of(Resolution::Ambiguous), "AMBIGUOUS");
}

TEST(SpinProducts, WhatSettledAnAxisIsItsEdgesOrAResolutionOfAFix) {
  EXPECT_EQ(name_of(SettledBy::Edges), "edges");
  EXPECT_EQ(name_of(settled_by(Resolution::Geometry)), "geometry");
  EXPECT_EQ(name_of(settled_by(Resolution::Constraint)), "constraint");
  EXPECT_EQ(name_of(settled_by(Resolution::Prior)), "prior");
  EXPECT_EQ(name_of(settled_by(Resolution::Dispersion)), "dispersion");
  EXPECT_EQ(name_of(settled_by(Resolution::Ambiguous)), "nothing");
}

TEST(SpinProducts, EstimatorsHaveTheNamesOfTheArchive) {
  EXPECT_EQ(name_of(SpinEstimator::Mean), "mean");
  EXPECT_EQ(name_of(SpinEstimator::Sequential), "sequential");
  EXPECT_EQ(name_of(SpinEstimator::Batch), "batch");
}

TEST(SpinProducts, ChannelsHaveTheNamesOfTheFiles) {
  using enum PulseChannel;
  EXPECT_EQ(name_of(Sun1), "sun1");
  EXPECT_EQ(name_of(Sun2), "sun2");
  EXPECT_EQ(name_of(NorthIn), "north_in");
  EXPECT_EQ(name_of(NorthOut), "north_out");
  EXPECT_EQ(name_of(SouthIn), "south_in");
  EXPECT_EQ(name_of(SouthOut), "south_out");
}

TEST(SpinProducts, AChannelIsFoundByItsExactNameOnly) {
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    EXPECT_EQ(pulse_channel_from(name_of(channel)), channel);
  }
  for (const auto* const wrong : {"", "sun", "sun3", "SUN1", " sun1", "sun1\r", "north"}) {
    EXPECT_FALSE(pulse_channel_from(wrong)) << wrong;
  }
}

}  // namespace spindrift::products_test
