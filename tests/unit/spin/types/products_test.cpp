#include "pipelines/spin/types/products.h"

#include <array>
#include <cmath>
#include <utility>

#include "tests/support/matchers.h"

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

template <class Code, std::size_t kCodes>
void expect_names(const std::pair<Code, std::string_view> (&names)[kCodes]) {
  for (const auto& [code, name] : names) {
    EXPECT_EQ(name_of(code), name);
  }
}

TEST(SpinProducts, CodesHaveTheNamesOfTheArchiveAndTheFiles) {
  using enum PulseChannel;
  expect_names<Rejection>({{Rejection::Unassociated, "unassociated"},
                           {Rejection::Late, "late"},
                           {Rejection::Geometry, "geometry"},
                           {Rejection::NoOrbit, "no_orbit"}});
  expect_names<Resolution>({{Resolution::Geometry, "GEOMETRY"},
                            {Resolution::Constraint, "CONSTRAINT"},
                            {Resolution::Prior, "PRIOR"},
                            {Resolution::Dispersion, "DISPERSION"},
                            {Resolution::Ambiguous, "AMBIGUOUS"}});
  expect_names<SpinEstimator>({{SpinEstimator::Mean, "mean"},
                               {SpinEstimator::Sequential, "sequential"},
                               {SpinEstimator::Batch, "batch"}});
  expect_names<PulseChannel>({{Sun1, "sun1"},
                              {Sun2, "sun2"},
                              {NorthIn, "north_in"},
                              {NorthOut, "north_out"},
                              {SouthIn, "south_in"},
                              {SouthOut, "south_out"}});
}

TEST(SpinProducts, WhatSettledAnAxisIsItsEdgesOrAResolutionOfAFix) {
  expect_names<SettledBy>({{SettledBy::Edges, "edges"},
                           {settled_by(Resolution::Geometry), "geometry"},
                           {settled_by(Resolution::Constraint), "constraint"},
                           {settled_by(Resolution::Prior), "prior"},
                           {settled_by(Resolution::Dispersion), "dispersion"},
                           {settled_by(Resolution::Ambiguous), "nothing"}});
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

SpinEstimate estimate_of(double noise_rad, const AxisShift& shift_icrf) {
  SpinEstimate estimate{};
  estimate.shift_icrf = shift_icrf;
  estimate.alignment_rad2(0, 0) = shift_icrf.squaredNorm();
  estimate.covariance_rad2 = estimate.alignment_rad2;
  estimate.covariance_rad2(1, 1) = noise_rad * noise_rad;
  return estimate;
}

TEST(SpinProducts, WhatErrorsOfTheMissionFileMoveAlikeDoesNotTellTwoEstimatesApart) {
  AxisShift shift_icrf = AxisShift::Zero();
  shift_icrf(0, NorthMountAngleError) = 0.3;
  const SpinEstimate one = estimate_of(0.03, shift_icrf);
  SpinEstimate other = estimate_of(0.02, shift_icrf);
  EXPECT_NEAR(difference_sigma_rad(one, other), 0.03, 1e-12);
  // The other is moved by 0.04 rad less, which is not known without its shift.
  shift_icrf(0, NorthMountAngleError) = 0.26;
  other = estimate_of(0.02, shift_icrf);
  EXPECT_NEAR(difference_sigma_rad(one, other), 0.05, 1e-12);
  other.shift_icrf.reset();
  EXPECT_NEAR(difference_sigma_rad(one, other), std::hypot(0.03, 0.3 + 0.26), 1e-12);
}

}  // namespace spindrift::products_test
