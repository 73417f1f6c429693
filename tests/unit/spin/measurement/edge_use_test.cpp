#include "pipelines/spin/measurement/edge_use.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::edge_use_test {

using enum PulseChannel;

/// Returns the rejection of a channel in a revolution with a north chord, whose end is rejected,
/// and a sun angle.
std::optional<Rejection> use_of(PulseChannel channel, Rejection out_rejected_by,
                                std::optional<Rejection> sun_angle_rejected_by = {}) {
  Revolution revolution{.number = 3,
                        .edges = {},
                        .period_candidate = {},
                        .period = {.period_s = 1.0, .sigma_s = 0.0}};
  revolution.edges.at(index_of(NorthIn)) = tai_from_ns(400'000'000);
  revolution.edges.at(index_of(NorthOut)) = tai_from_ns(500'000'000);
  revolution.edge_rejections.at(index_of(NorthOut)) = out_rejected_by;
  const std::vector<Verdict> verdicts = {
      {.quantity = SpinQuantity::NorthChord, .rejected_by = out_rejected_by},
      {.quantity = SpinQuantity::SunAngle, .rejected_by = sun_angle_rejected_by}};
  const auto uses = edge_uses(usual_config(), revolution, verdicts);
  const auto use =
      std::ranges::find_if(uses, [&](const PulseUse& u) { return u.pulse.channel == channel; });
  return use->rejected_by;
}

TEST(EdgeUse, AMeasurementThatAnotherEdgeHasSpoiltSaysNothingAboutThisOne) {
  for (const Rejection rejection : {Rejection::Phase, Rejection::Interference}) {
    EXPECT_EQ(use_of(NorthOut, rejection), rejection);
    EXPECT_EQ(use_of(NorthIn, rejection), std::nullopt);
  }
}

TEST(EdgeUse, WithoutAnOrbitEvenALoneEdgeIsNotAccepted) {
  EXPECT_EQ(use_of(NorthIn, Rejection::Phase, Rejection::NoOrbit), Rejection::NoOrbit);
  EXPECT_EQ(use_of(NorthOut, Rejection::Phase, Rejection::NoOrbit), Rejection::Phase);
}

}  // namespace spindrift::testing::edge_use_test
