/// @file
/// A bank of filters without a gyro on a tumbling body, from nothing.

#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <deque>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/unscented/gukf_bank.h"
#include "tests/support/normalised_square.h"
#include "tests/support/tumbling_body.h"

namespace spindrift::testing {

struct BankOutcome {
  double off_at_900_s_deg = 180.0;
  double off_deg = 180.0;
  double rate_off_deg_s = 0.0;
  double sigma_deg = 0.0;  ///< Of the attitude, all axes together.
  double nees = 0.0;       ///< Of attitude and rate.
  double mean_nis = 0.0;   ///< Of the last 600 s.
  double lead_nats = 0.0;
  /// Sigma, mean NIS and lead allow to trust the attitude.
  bool is_safe() const { return sigma_deg < 5.0 && mean_nis < 4.0 && lead_nats >= 50.0; }
  bool is_right() const { return off_deg < 1.0 && rate_off_deg_s < 0.01; }
};

inline Eigen::Matrix<double, 6, 1> motion_error(const Gukf& filter, const BodyState& truth) {
  Eigen::Matrix<double, 6, 1> error;
  error << error_rad(filter.q_icrf_body(), truth.q_icrf_body),
      truth.rate_body_rad_s - filter.rate_rad_s();
  return error;
}

/// @param seen What the magnetometer sends; may alter what it has measured.
template <class Seen>
BankOutcome bank_outcome(const GukfModel& model, TumblingBody& body, double period_s,
                         double duration_s, const Seen& seen) {
  const SeenField first = seen(body.field());
  body.advance(period_s);
  GukfBank bank{model, first, seen(body.field()), period_s};
  std::deque<double> recent_nis;
  BankOutcome outcome;
  while (body.t_s() + period_s <= duration_s) {
    body.advance(period_s);
    bank.propagate(period_s, {}, body.position_icrf_km(body.t_s() - 0.5 * period_s));
    const SeenField field = seen(body.field());
    recent_nis.push_back(bank.innovation(field).nis);
    if (static_cast<double>(recent_nis.size()) * period_s > 600.0) {
      recent_nis.pop_front();
    }
    bank.update(field);
    if (body.t_s() <= 900.0) {
      outcome.off_at_900_s_deg = degrees(motion_error(bank.best(), body.state()).head<3>().norm());
    }
  }
  const Eigen::Matrix<double, 6, 1> error = motion_error(bank.best(), body.state());
  outcome.off_deg = degrees(error.head<3>().norm());
  outcome.rate_off_deg_s = degrees(error.tail<3>().norm());
  outcome.sigma_deg = degrees(std::sqrt(bank.best().attitude_covariance_rad2().trace()));
  outcome.nees = normalised_square<6>(error, bank.best().covariance());
  for (const double nis : recent_nis) {
    outcome.mean_nis += nis / static_cast<double>(recent_nis.size());
  }
  outcome.lead_nats = bank.lead_nats();
  return outcome;
}

inline BankOutcome bank_outcome(const GukfModel& model, TumblingBody& body, double period_s,
                                double duration_s) {
  return bank_outcome(model, body, period_s, duration_s,
                      [](const SeenField& field) { return field; });
}

}  // namespace spindrift::testing
