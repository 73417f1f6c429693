/// @file
/// Tells whose error it is that the magnetometer contradicts the field of the
/// model, from how the difference moves while the body turns.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "pipelines/time/tai_time.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

/// The error of a magnetometer stands still in body axes or scatters; that of
/// an orbit, at whose place the field is another one, stands still in ICRF.
class FieldDeparture {
 public:
  enum class Of { Unknown, Magnetometer, Orbit };

  /// @param off_body_nt Measured field minus that of the model. @param noise_nt
  /// Noise per axis.
  void add(TaiTime t, const Eigen::Quaterniond& q_icrf_body, const Eigen::Vector3d& off_body_nt,
           double noise_nt) {
    const double left = last_ ? std::exp(-elapsed_s(last_->t, t) / kRecent_s) : 0.0;
    const Eigen::Vector3d step_nt = off_body_nt - (last_ ? last_->off_body_nt : off_body_nt);
    count_ = left * count_ + 1.0;
    noise_nt2_ = left * noise_nt2_ + 3.0 * noise_nt * noise_nt;
    squares_nt2_ = left * squares_nt2_ + off_body_nt.squaredNorm();
    steps_nt2_ = left * steps_nt2_ + 0.5 * step_nt.squaredNorm();
    body_nt_ = left * body_nt_ + off_body_nt;
    icrf_nt_ = left * icrf_nt_ + q_icrf_body * off_body_nt;
    last_ = Last{.t = t, .off_body_nt = off_body_nt};
  }

  Of whose() const {
    if (count_ < kFewest) {
      return Of::Unknown;
    }
    if (steps_nt2_ > kScatters * noise_nt2_) {
      return Of::Magnetometer;
    }
    const double in_body_nt2 = squares_nt2_ - body_nt_.squaredNorm() / count_;
    const double in_icrf_nt2 = squares_nt2_ - icrf_nt_.squaredNorm() / count_;
    if (std::max(in_body_nt2, in_icrf_nt2) <
        kTold * std::max(noise_nt2_, std::min(in_body_nt2, in_icrf_nt2))) {
      return Of::Unknown;
    }
    return in_body_nt2 < in_icrf_nt2 ? Of::Magnetometer : Of::Orbit;
  }

 private:
  static constexpr double kRecent_s = 60.0;
  static constexpr double kFewest = 10.0;
  // Variances over that of the noise or of the other frame, beyond chance.
  static constexpr double kScatters = 25.0;
  static constexpr double kTold = 2.0;

  struct Last {
    TaiTime t;
    Eigen::Vector3d off_body_nt;
  };
  std::optional<Last> last_;
  double count_ = 0.0;
  double noise_nt2_ = 0.0;    ///< Expected sum of squares by noise.
  double squares_nt2_ = 0.0;  ///< Sum of the squares of the differences.
  double steps_nt2_ = 0.0;    ///< Sum of half the squares of their changes.
  Eigen::Vector3d body_nt_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d icrf_nt_ = Eigen::Vector3d::Zero();
};

}  // namespace spindrift
