#include "services/products/not_finite.h"

#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "services/products/products.h"
#include "tests/support/matchers.h"

namespace spindrift::not_finite_test {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();

SpinEstimate an_estimate() {
  return {.t = tai_from_ns(7),
          .estimator = SpinEstimator::Mean,
          .axis_icrf = Eigen::Vector3d::UnitX(),
          .covariance_rad2 = Eigen::Matrix2d::Identity(),
          .spin_rate_rad_s = 6.0,
          .spin_rate_sigma_rad_s = 0.1,
          .assessment = {.quality = Quality::Ok}};
}

BatchSolution a_solution() {
  return {.estimate = an_estimate(),
          .drift_rad_s2 = 1e-6,
          .drift_sigma_rad_s2 = 1e-8,
          .bound_rad = 1e-4,
          .biases = {BiasEstimate{NorthChordBias, 0.01, 0.001, true, true}},
          .undetermined = {},
          .singular_values = {},
          .changed = {},
          .edges = 100,
          .outliers = 0,
          .noise = 1.0,
          .iterations = 5,
          .nutation = {},
          .nutation_t = tai_from_ns(7),
          .coning = {}};
}

BatchProduct shared(BatchSolution solution) {
  return std::make_shared<const BatchSolution>(std::move(solution));
}

template <class Kind>
std::string place_in(const Kind& product) {
  const auto found = not_finite(product);
  return found ? std::string{found->table} + "." + std::string{found->column} : "";
}

TEST(NotFinite, FindsNothingInNumbers) {
  EXPECT_EQ(place_in(PulseUse{}), "");
  EXPECT_EQ(place_in(an_estimate()), "");
  EXPECT_EQ(place_in(shared(a_solution())), "");
}

TEST(NotFinite, NamesTableAndColumn) {
  SpinEstimate estimate = an_estimate();
  estimate.spin_rate_sigma_rad_s = kNone;
  EXPECT_EQ(place_in(estimate), "spin_estimate.sigma_rpm");
  estimate = an_estimate();
  estimate.axis_icrf.z() = kNone;
  EXPECT_EQ(place_in(estimate), "spin_estimate.dec_deg");
  EXPECT_EQ(place_in(RevolutionProduct{.revolution = 1, .t_sun1 = {}, .period_s = kEndless}),
            "revolution.period_s");
  EXPECT_EQ(place_in(SpinMeasurement{.revolution = 1,
                                     .quantity = SpinQuantity::SunAngle,
                                     .value = 1.0,
                                     .sigma = kNone,
                                     .rejected_by = {}}),
            "spin_measurement.sigma");
}

TEST(NotFinite, LooksAtTheValuesOfReasons) {
  SpinEstimate estimate = an_estimate();
  estimate.assessment.reasons = {{ReasonCode::Noise, {{"factor", 1.5}}}};
  EXPECT_EQ(place_in(estimate), "");
  // NaN would be null in JSON.
  estimate.assessment.reasons.push_back({ReasonCode::ModelOff, {{"deg", kNone}}});
  EXPECT_EQ(place_in(estimate), "spin_estimate.reasons");
}

TEST(NotFinite, LooksAtNumbersThatAreStoredAsText) {
  NormalEquations said{.t = tai_from_ns(7),
                       .names = {"gyro_scale_x"},
                       .b0 = Eigen::VectorXd::Zero(1),
                       .n = Eigen::MatrixXd::Ones(1, 1),
                       .g = Eigen::VectorXd::Zero(1)};
  EXPECT_EQ(place_in(said), "");
  said.g[0] = kNone;
  EXPECT_EQ(place_in(said), "normal_equations.n");
}

TEST(NotFinite, LooksAtEveryTableAndRowOfAProduct) {
  BatchSolution solution = a_solution();
  solution.biases.push_back(BiasEstimate{DihedralBias, 0.01, kEndless, true, true});
  EXPECT_EQ(place_in(shared(solution)), "spin_bias.sigma");
  solution = a_solution();
  solution.singular_values = {1.0, kNone};
  EXPECT_EQ(place_in(shared(solution)), "spin_batch_singular_value.value");
  solution = a_solution();
  solution.coning.verdict.detected = true;
  solution.coning.tilt_sigma_rad = kNone;
  EXPECT_EQ(place_in(shared(solution)), "spin_coning.tilt_sigma_deg");
  // Values of a coning that was not detected are not checked.
  solution.coning.verdict.detected = false;
  EXPECT_EQ(place_in(shared(solution)), "");
}

}  // namespace spindrift::not_finite_test
