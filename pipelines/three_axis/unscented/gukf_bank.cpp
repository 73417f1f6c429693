#include "pipelines/three_axis/unscented/gukf_bank.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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
constexpr double kStartSigma_rad = 40.0 * kRadPerDeg;
constexpr double kStartRateSigma_rad_s = 1.0 * kRadPerDeg;
constexpr double kForgotten_s = 600.0;
constexpr double kApart_rad = 15.0 * kRadPerDeg;
constexpr double kHopeless_nats = 1000.0;

UncertainMotion start_at(const Quaterniond& q_icrf_body, const Vector3d& rate_body_rad_s) {
  UncertainMotion start{.motion = {.q_icrf_body = q_icrf_body, .rate_body_rad_s = rate_body_rad_s},
                        .covariance = Eigen::Matrix<double, 6, 6>::Zero()};
  start.covariance.topLeftCorner<3, 3>() = kStartSigma_rad * kStartSigma_rad * Matrix3d::Identity();
  start.covariance.bottomRightCorner<3, 3>() =
      kStartRateSigma_rad_s * kStartRateSigma_rad_s * Matrix3d::Identity();
  return start;
}

}  // namespace

GukfBank::GukfBank(const GukfModel& model, const SeenField& first, const SeenField& second,
                   double dt_s) {
  const Vector3d along = second.body_nt.normalized();
  const Quaterniond q_icrf_body = shortest_turn(along, second.ref_icrf_nt.normalized());
  // A body seems to turn the field the other way, and the field turns along the orbit.
  const Vector3d against_field_rad =
      rotation_vector_of(shortest_turn(along, first.body_nt.normalized()));
  const Vector3d field_rad = rotation_vector_of(
      shortest_turn(first.ref_icrf_nt.normalized(), second.ref_icrf_nt.normalized()));
  for (int start = 0; start < kStarts; ++start) {
    const Quaterniond q =
        q_icrf_body * quaternion_by(2.0 * std::numbers::pi / kStarts * start * along);
    const Vector3d rate_rad_s = (against_field_rad + q.conjugate() * field_rad) / dt_s;
    hypotheses_.push_back({.filter = Gukf{model, start_at(q, rate_rad_s)}, .log_likelihood = 0.0});
  }
}

GukfBank::GukfBank(const GukfModel& model, const UncertainMotion& start)
    : hypotheses_{{.filter = Gukf{model, start}, .log_likelihood = 0.0}} {}

void GukfBank::propagate(double dt_s, const BodyTorques& torques) {
  const double left = std::exp(-dt_s / kForgotten_s);
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.filter.propagate(dt_s, torques);
    hypothesis.log_likelihood *= left;
  }
}

template <class Measurement>
void GukfBank::update_all(const Measurement& measurement) {
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.log_likelihood += hypothesis.filter.innovation(measurement).log_likelihood;
    hypothesis.filter.update(measurement);
  }
  choose();
}
template void GukfBank::update_all(const SeenField&);
template void GukfBank::update_all(const SeenSun&);
template void GukfBank::update_all(const SeenStars&);

void GukfBank::choose() {
  const auto best = std::max_element(
      hypotheses_.begin(), hypotheses_.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.log_likelihood < b.log_likelihood; });
  std::swap(*best, hypotheses_.front());
  const Hypothesis& winner = hypotheses_.front();
  const auto left =
      std::remove_if(hypotheses_.begin() + 1, hypotheses_.end(), [&](const Hypothesis& other) {
        return !(winner.log_likelihood - other.log_likelihood < kHopeless_nats);
      });
  hypotheses_.erase(left, hypotheses_.end());
}

double GukfBank::lead_nats() const {
  double lead = std::numeric_limits<double>::infinity();
  for (const Hypothesis& other : hypotheses_) {
    if (angle_between_rad(best().q_icrf_body(), other.filter.q_icrf_body()) > kApart_rad) {
      lead = std::min(lead, hypotheses_.front().log_likelihood - other.log_likelihood);
    }
  }
  return lead;
}

}  // namespace spindrift
