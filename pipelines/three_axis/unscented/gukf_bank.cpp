#include "pipelines/three_axis/unscented/gukf_bank.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/frames/shortest_turn.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr int kStarts = 8;
/// Starting sigmas: about the field, across it, where its measured direction is known but not how
/// the filters will turn, and of the rate.
constexpr double kAboutField_rad = 40.0 * kRadPerDeg;
constexpr double kAcrossField_rad = 10.0 * kRadPerDeg;
constexpr double kStartRate_rad_s = 1.0 * kRadPerDeg;
/// Two fields that are closer in time do not tell the rate.
constexpr double kLeastBetween_s = 5.0;

constexpr double kForgotten_s = 600.0;
/// Before this time no filter is judged for itself.
constexpr double kJudged_s = 200.0;
/// A filter that is less likely than another by so much is dropped.
constexpr double kHopeless_nats = 300.0;
constexpr double kApart_rad = 15.0 * kRadPerDeg;

/// A normalised square counts up to that which chance exceeds once in a thousand times.
constexpr double kMostSquare = 16.27;
/// With more of their expectation the squares contradict the filter.
constexpr double kMostSquares = 1.6;

/// An error of the mission file that is estimated larger than this contradicts the filter.
constexpr double kMostPriorSigmas = 5.0;

/// An attitude with a smaller sigma and a larger lead is clear; the filter then starts again.
constexpr double kClear_rad = 1.0 * kRadPerDeg;
constexpr double kClear_nats = 50.0;
constexpr double kAgain_rad = 3.0 * kRadPerDeg;
constexpr double kAgainRate_rad_s = 0.05 * kRadPerDeg;

UncertainMotion uncertain(const BodyState& motion, const Matrix3d& turn_rad2, double rate_rad_s) {
  UncertainMotion start{.motion = motion, .covariance = Eigen::Matrix<double, 6, 6>::Zero()};
  start.covariance.topLeftCorner<3, 3>() = turn_rad2;
  start.covariance.bottomRightCorner<3, 3>() = rate_rad_s * rate_rad_s * Matrix3d::Identity();
  return start;
}

}  // namespace

GukfBank::GukfBank(const GukfModel& model, const SeenField& first, const SeenField& second,
                   double dt_s)
    : model_{model}, last_field_{second} {
  start_from(first, second, dt_s);
}

GukfBank::GukfBank(const GukfModel& model, const UncertainMotion& start)
    : model_{model}, hypotheses_{{.filter = Gukf{model, start}, .is_settled = true}} {}

void GukfBank::start_from(const SeenField& first, const SeenField& second, double dt_s) {
  const Vector3d along = second.body_nt.normalized();
  const Quaterniond q_icrf_body = shortest_turn(along, second.ref_icrf_nt.normalized());
  const Matrix3d turn_rad2 =
      kAcrossField_rad * kAcrossField_rad * Matrix3d::Identity() +
      (kAboutField_rad * kAboutField_rad - kAcrossField_rad * kAcrossField_rad) * along *
          along.transpose();
  // The field turns in body axes against the body, and in ICRF along the orbit.
  const Vector3d body_rad = rotation_vector_of(shortest_turn(along, first.body_nt.normalized()));
  const Vector3d field_rad = rotation_vector_of(
      shortest_turn(first.ref_icrf_nt.normalized(), second.ref_icrf_nt.normalized()));
  hypotheses_.clear();
  for (int start = 0; start < kStarts; ++start) {
    const Quaterniond q =
        q_icrf_body * quaternion_by(2.0 * std::numbers::pi / kStarts * start * along);
    const Vector3d rate_rad_s = (body_rad + q.conjugate() * field_rad) / dt_s;
    hypotheses_.push_back(
        {.filter = Gukf{model_, uncertain({q, rate_rad_s}, turn_rad2, kStartRate_rad_s)}});
  }
  since_start_s_ = 0.0;
}

void GukfBank::propagate(double dt_s, const BodyTorques& torques,
                         const std::optional<Vector3d>& position_icrf_km) {
  const double left = std::exp(-dt_s / kForgotten_s);
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.filter.propagate(dt_s, torques, position_icrf_km);
    hypothesis.log_likelihood *= left;
    hypothesis.squares *= left;
    hypothesis.freedom *= left;
  }
  since_field_s_ += dt_s;
  since_start_s_ += dt_s;
}

void GukfBank::update(const SeenField& field) {
  update_all(field);
  if (last_field_ && since_field_s_ < kLeastBetween_s) {
    return;
  }
  if (last_field_ && is_contradicted()) {
    start_from(*last_field_, field, since_field_s_);
  }
  last_field_ = field;
  since_field_s_ = 0.0;
}

template <class Measurement>
void GukfBank::update_all(const Measurement& measurement) {
  for (Hypothesis& hypothesis : hypotheses_) {
    const UnscentedInnovation innovation = hypothesis.filter.innovation(measurement);
    const bool is_finite = std::isfinite(innovation.log_likelihood);
    hypothesis.log_likelihood +=
        is_finite ? innovation.log_likelihood : -std::numeric_limits<double>::infinity();
    hypothesis.squares += is_finite ? std::min(innovation.nis, kMostSquare) : kMostSquare;
    hypothesis.freedom += innovation.residual.freedom;
    hypothesis.filter.update(measurement);
  }
  choose();
  if (!is_settled()) {
    settle();
  }
}
template void GukfBank::update_all(const SeenField&);
template void GukfBank::update_all(const SeenSun&);
template void GukfBank::update_all(const SeenStars&);

/// Finds the most likely filter, and drops those without hope.
void GukfBank::choose() {
  const auto best = std::max_element(
      hypotheses_.begin(), hypotheses_.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.log_likelihood < b.log_likelihood; });
  std::swap(*best, hypotheses_.front());
  const double least = hypotheses_.front().log_likelihood - kHopeless_nats;
  std::erase_if(hypotheses_,
                [least](const Hypothesis& other) { return !(other.log_likelihood >= least); });
}

/// On the way from a wrong attitude a filter takes errors of the attitude for those of the mission
/// file, and does not forget this. Once the attitude is clear it starts again from there, with the
/// moments that it has found, since what they do is far from linear. What has come to the same
/// attitude is dropped.
void GukfBank::settle() {
  const Gukf& found = best();
  if (since_start_s_ < kJudged_s || is_contradicted() || lead_nats() < kClear_nats ||
      found.attitude_covariance_rad2().trace() > kClear_rad * kClear_rad) {
    return;
  }
  const BodyState motion{found.q_icrf_body(), found.rate_rad_s()};
  std::erase_if(hypotheses_, [&](const Hypothesis& other) {
    return &other != &hypotheses_.front() && !is_apart(other.filter);
  });
  hypotheses_.front().filter = best().started_again(
      model_, uncertain(motion, kAgain_rad * kAgain_rad * Matrix3d::Identity(), kAgainRate_rad_s));
  hypotheses_.front().is_settled = true;
}

bool GukfBank::is_contradicted() const {
  const Hypothesis& winner = hypotheses_.front();
  return !std::isfinite(winner.log_likelihood) ||
         (since_start_s_ >= kJudged_s && (winner.squares > kMostSquares * winner.freedom ||
                                          winner.filter.most_prior_sigmas() > kMostPriorSigmas));
}

bool GukfBank::is_apart(const Gukf& other) const {
  return angle_between_rad(best().q_icrf_body(), other.q_icrf_body()) > kApart_rad;
}

double GukfBank::lead_nats() const {
  double lead = std::numeric_limits<double>::infinity();
  for (const Hypothesis& other : hypotheses_) {
    if (is_apart(other.filter)) {
      lead = std::min(lead, hypotheses_.front().log_likelihood - other.log_likelihood);
    }
  }
  return lead;
}

}  // namespace spindrift
