/// Satellites that differ from their mission file: the mean has a bias that more fixes do not
/// reduce, and its sigma must not claim otherwise.

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::spin_model_errors_test {

constexpr double kRevolutions = 300.0;

/// Changes the mission's configuration so that it differs from the body.
struct Mistake {
  std::string name;
  std::function<void(SpinConfig& said)> make;
};

std::vector<Mistake> mistakes(double size_rad) {
  std::vector<Mistake> all;
  for (const double off_rad : {size_rad, -size_rad}) {
    all.push_back(
        {"separation", [=](SpinConfig& said) { said.sun_sensor.slit_separation_rad += off_rad; }});
    all.push_back({"cant", [=](SpinConfig& said) { said.sun_sensor.slit_cant_rad += off_rad; }});
    all.push_back(
        {"north mount", [=](SpinConfig& said) { said.north->mount_angle_rad += off_rad; }});
    all.push_back(
        {"south mount", [=](SpinConfig& said) { said.south->mount_angle_rad += off_rad; }});
    all.push_back({"north azimuth", [=](SpinConfig& said) { said.north->azimuth_rad += off_rad; }});
    all.push_back({"south azimuth", [=](SpinConfig& said) { said.south->azimuth_rad += off_rad; }});
  }
  return all;
}

struct Outcome {
  std::string mistake;
  double sigmas;  ///< Error of the mean over its sigma.
  Assessment assessment;

  bool model_off() const { return has(assessment, ReasonCode::ModelOff); }
  bool doubtful() const { return assessment.quality == Quality::Doubtful; }
};

/// Runs every mistake on every body; north chords are too long by `excess_rad`.
std::vector<Outcome> outcomes_of(const std::vector<Mistake>& mistakes, double excess_rad,
                                 int bodies) {
  const Surroundings from;
  std::mt19937_64 rng{77};
  std::vector<Outcome> outcomes;
  for (int i = 0; i < bodies; ++i) {
    const SpinningBody body = random_body(from.around, 8.0 * kRadPerDeg, rng);
    auto edges = edges_between(body, from.around, 0.0, body.seconds_of(kRevolutions));
    for (Edge& edge : edges) {
      const double late_s = 0.5 * excess_rad / body.rate_rad_s;
      edge.t_s += edge.channel == PulseChannel::NorthOut ? late_s : 0.0;
      edge.t_s -= edge.channel == PulseChannel::NorthIn ? late_s : 0.0;
    }
    const auto pulses = noisy_pulses(body, edges, rng);
    for (const Mistake& mistake : mistakes) {
      SpinConfig said = body.config;
      mistake.make(said);
      const SpinEstimate mean =
          last_estimate(run(SpinPass{said, from.orbit}, pulses), SpinEstimator::Mean);
      outcomes.push_back(
          {.mistake = mistake.name,
           .sigmas = error_rad(mean.axis_icrf, body.axis_icrf).norm() / sigma_rad(mean),
           .assessment = mean.assessment});
    }
  }
  return outcomes;
}

/// The expected shares come from sixty bodies with other seeds (both signs of each mistake). The
/// limits are four sigmas wider for the number of bodies here.
TEST(SpinModelErrors, OfADegreeAreCoveredWhereverTheyShow) {
  int separations_shown = 0;
  int separations_uncovered = 0;
  int azimuths_believed = 0;
  int mounts_uncovered = 0;
  for (const Outcome& outcome : outcomes_of(mistakes(1.0 * kRadPerDeg), 0.0, 16)) {
    SCOPED_TRACE(outcome.mistake + ": " + sentence_of(outcome.assessment));
    const bool azimuth = outcome.mistake.ends_with("azimuth");
    const bool separation = outcome.mistake == "separation";
    const bool uncovered = !(outcome.sigmas < 3.5);
    separations_shown += separation && outcome.model_off() ? 1 : 0;
    separations_uncovered += separation && outcome.model_off() && uncovered ? 1 : 0;
    azimuths_believed += azimuth && !outcome.doubtful() ? 1 : 0;
    // A mean that has just restarted reports too few fixes instead of a wrong model.
    EXPECT_TRUE(outcome.model_off() || has(outcome.assessment, ReasonCode::FewFixes) || !azimuth);
    // With Sun and Earth perpendicular to the axis, the sun angle hardly affects anything that can
    // be compared, so noise may hide a wrong separation.
    mounts_uncovered += outcome.mistake.ends_with("mount") && uncovered ? 1 : 0;
    EXPECT_FALSE(uncovered && outcome.model_off() && !separation);
  }
  // 32 bodies; the share with other seeds was 50 of 60, both signs of a body alike.
  EXPECT_GE(separations_shown, 15);
  EXPECT_LE(separations_uncovered, 4);  // Noise hides 1 of 50 that show.
  // 64 outcomes; none of 120 with other seeds, where hardly anything shows the error.
  EXPECT_LE(mounts_uncovered, 3);
  EXPECT_LE(azimuths_believed, 4);  // 64 outcomes; 1 of 120 with other seeds.
}

TEST(SpinModelErrors, OfThreeTenthsOfADegreeAreCoveredWhereverTheyShow) {
  int shown = 0;
  for (const Outcome& outcome : outcomes_of(mistakes(0.3 * kRadPerDeg), 0.0, 16)) {
    SCOPED_TRACE(outcome.mistake + ": " + sentence_of(outcome.assessment));
    shown += outcome.model_off() ? 1 : 0;
    EXPECT_TRUE(outcome.model_off() || !outcome.mistake.ends_with("azimuth"));
    EXPECT_LT(outcome.model_off() ? outcome.sigmas : 0.0, 3.5);
    EXPECT_FALSE(outcome.doubtful());  // The error is two sigmas of the allowance for model errors.
  }
  EXPECT_GT(shown,
            90);  // 192 outcomes; 231 of 360 with other seeds, minus four sigmas of sixteen bodies.
}

TEST(SpinModelErrors, OfAChordAreCovered) {
  const Mistake none{"none", [](SpinConfig&) {}};
  for (const double excess_rad : {0.3 * kRadPerDeg, -0.3 * kRadPerDeg}) {
    for (const Outcome& outcome : outcomes_of({none}, excess_rad, 4)) {
      SCOPED_TRACE(sentence_of(outcome.assessment));
      EXPECT_TRUE(outcome.model_off());
      EXPECT_LT(outcome.sigmas, 3.5);
    }
  }
}

}  // namespace spindrift::testing::spin_model_errors_test
