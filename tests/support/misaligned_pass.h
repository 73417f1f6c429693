/// @file
/// Passes of a three-axis spacecraft whose mission file is off by errors drawn from what it states,
/// and a comparison of the attitudes with the truth.

#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "pipelines/three_axis/attitude_estimator.h"
#include "pipelines/three_axis/config.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing {

using AlignmentErrors = Eigen::Matrix<double, kAttitudeAlignmentErrors, 1>;

/// Returns the standard deviations that a mission file has by default.
AlignmentErrors default_alignment();
/// Returns errors with these standard deviations.
AlignmentErrors drawn(const AlignmentErrors& sigmas, std::mt19937_64& rng);

/// Adds errors of the mission file to what sensors say.
class MisalignedSensors {
 public:
  MisalignedSensors(const TurningBody& body, const ThreeAxisConfig& config,
                    const AlignmentErrors& errors, std::mt19937_64& rng);

  GyroSample gyro(double t_s);
  StarFix star(double t_s);
  Eigen::Vector3d sun(double t_s, const Eigen::Vector3d& ref_icrf);
  Eigen::Vector3d field_nt(double t_s, const Eigen::Vector3d& ref_icrf_nt);
  const Eigen::Vector3d& bias_rad_s() const { return sensors_.bias_rad_s(); }

 private:
  Eigen::Quaterniond turned_by(double t_s, int mounting, int time_tag) const;

  const TurningBody& body_;
  ThreeAxisConfig config_;
  AlignmentErrors errors_;
  Sensors sensors_;
};

/// Holds what a pass has beside its gyro, at 10 Hz; each sensor gives one sample a second.
struct MisalignedScene {
  bool star;
  bool sun;
  bool field;
  double most_rad_s;  ///< Largest rate about each axis.
  int duration_s;
};

/// Holds an attitude beside the truth.
struct JudgedAttitude {
  double t_s;
  AttitudeEstimate estimate;
  Eigen::Vector3d error_rad;

  bool is_ok() const { return estimate.assessment.quality == Quality::Ok; }
  /// Returns the error in its standard deviations, all axes together.
  double sigmas() const { return error_rad.norm() / estimate.sigma_rad(); }
  /// Returns the chi-square of the error, of three degrees of freedom.
  double square() const;
};

struct MisalignedPass {
  std::vector<JudgedAttitude> rows;
  AttitudeEstimator estimator;
};

/// @param alignment Standard deviations that the estimator is told.
MisalignedPass fly(const MisalignedScene& scene, const AlignmentErrors& errors,
                   const AlignmentErrors& alignment, std::mt19937_64& rng);

/// Flies this many passes each with star fixes, star fixes and Sun, and Sun and field, whose errors
/// are drawn from the default alignment. Expects that the errors of attitudes and the estimates of
/// the errors have the covariance that is stated, that no OK row is more than 5 sigma off and one
/// in a thousand more than 4, and that about as many rows are OK as with an exact mission file.
void expect_sigma_that_holds(int passes_of_each);

}  // namespace spindrift::testing
