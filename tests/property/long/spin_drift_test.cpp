#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/assessed.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::spin_drift_test {

constexpr double kRpm_rad_s = std::numbers::pi / 30.0;

struct DriftingPass {
  Orbit orbit = transfer_orbit();
  double rate_rad_s;  ///< Spin rate at the start.
  double drift_rad_s2;

  double rate_at(double t_s) const { return rate_rad_s + drift_rad_s2 * t_s; }
  /// Returns the time at which a body of constant rate would have turned as far as at `t_s`.
  double even_s(double t_s) const { return t_s + 0.5 * drift_rad_s2 / rate_rad_s * t_s * t_s; }
  /// Returns the inverse of even_s().
  double drifting_s(double even_s) const {
    const double rate_then = std::sqrt(1.0 + 2.0 * drift_rad_s2 / rate_rad_s * even_s);
    return 2.0 * even_s / (1.0 + rate_then);
  }

  /// Returns Sun and Earth by the time that even_s() gives.
  SunEarthEphemeris around() const {
    const auto seen = seen_from(orbit);
    const DriftingPass pass = *this;
    return {.sun_icrf = [pass, seen](double t_s) { return seen.sun_icrf(pass.drifting_s(t_s)); },
            .earth_icrf_km = [pass, seen](double t_s) -> Eigen::Vector3d {
              return seen.earth_icrf_km(pass.drifting_s(t_s));
            },
            .horizon_km = seen.horizon_km};
  }

  std::vector<Pulse> pulses(const SpinningBody& body, double duration_s,
                            std::mt19937_64& rng) const {
    std::vector<Edge> edges = edges_between(body, around(), 0.0, even_s(duration_s));
    for (Edge& edge : edges) {
      edge.t_s = drifting_s(edge.t_s);
    }
    return noisy_pulses(body, edges, rng);
  }
};

struct Share {
  int estimates = 0;
  int beyond_three = 0;

  void add(double normalised_error) {
    ++estimates;
    beyond_three += std::abs(normalised_error) > 3.0 ? 1 : 0;
  }
};

TEST(SpinDrift, RateAndAxisMeanWhatTheirSigmasSay) {
  std::mt19937_64 rng{801};
  Share mean;
  Share sequential;
  for (const double rpm : {5.5, 20.0, 60.0, 200.0}) {
    for (const double drift_rpm_h : {-2.0, -1.0, 0.1, 2.0}) {
      SCOPED_TRACE(::testing::Message() << rpm << " rpm, " << drift_rpm_h << " rpm/h");
      const DriftingPass pass{.rate_rad_s = rpm * kRpm_rad_s,
                              .drift_rad_s2 = drift_rpm_h * kRpm_rad_s / 3600.0};
      SpinningBody body = random_body(pass.around(), 2.0 * kRadPerDeg, rng);
      body.rate_rad_s = pass.rate_rad_s;
      // The timing noise is chosen to be the same angle at every rate.
      body.config.noise = {.sun_s = 6e-3 / rpm, .infrared_s = 3e-2 / rpm};
      const double duration_s = std::clamp(200.0 * 60.0 / rpm, 120.0, 1200.0);
      const SpinOutput output =
          run(SpinPass{body.config, pass.orbit}, pass.pulses(body, duration_s, rng));
      for (const SpinEstimate& estimate : all_of<SpinEstimate>(output)) {
        const double rate_rad_s = pass.rate_at(seconds_between(kTransferStart, estimate.t));
        (estimate.estimator == SpinEstimator::Mean ? mean : sequential)
            .add((estimate.spin_rate_rad_s - rate_rad_s) / estimate.spin_rate_sigma_rad_s);
      }
      for (const SpinEstimator estimator : {SpinEstimator::Mean, SpinEstimator::Sequential}) {
        const SpinEstimate last = last_estimate(output, estimator);
        EXPECT_GT(seconds_between(kTransferStart, last.t), duration_s - 3.0 * 60.0 / rpm);
        EXPECT_LT(angle_between_rad(last.axis_icrf, body.axis_icrf), 4.0 * sigma_rad(last));
        EXPECT_FALSE(restarted(last.assessment)) << sentence_of(last.assessment);
        // The limit is half an rpm an hour over a minute.
        EXPECT_LT(last.spin_rate_sigma_rad_s, 0.5 / 60.0 * kRpm_rad_s);
      }
    }
  }
  for (const Share& share : {mean, sequential}) {
    EXPECT_GT(share.estimates, 3000);
    EXPECT_LT(share.beyond_three, 0.01 * share.estimates);
  }
}

}  // namespace spindrift::testing::spin_drift_test
