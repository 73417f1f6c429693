/// @file
/// The attitude that a very small satellite computes itself, from Sun and field (Liu 2019,
/// par. 3.1): the field of the orbit is that of its table, the Sun that of a short formula.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/geomagnetism/tables/field_table.h"
#include "pipelines/three_axis/samples.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Noise of the sensors in Liu 2019, par. 3.3: of each component of the sun vector, and of the
/// field along each axis.
inline constexpr double kStudySunNoise = 0.01;
inline constexpr double kStudyFieldNoise_nt = 10.0;

/// The two vectors in one frame.
struct SunAndField {
  Eigen::Vector3d sun;  ///< Unit vector but for noise.
  Eigen::Vector3d field_nt;
};

/// Computes the attitude by TRIAD, the Sun first, as in the paper.
/// @return q_orbit_body; Unobservable where Sun and field are in line.
Expected<Eigen::Quaterniond> two_vector_attitude(const SunAndField& body, const SunAndField& orbit);

/// Returns the Sun as a small controller computes it: the mean longitude (Simon et al. 1994) and
/// two terms of the equation of the centre, without aberration and parallax.
/// @return Unit vector, EME2000, within 0.02 deg from 1950 to 2050.
Eigen::Vector3d sun_by_formula_icrf(TaiTime t);

/// The attitude at an instant, as computed with the table and, to show what the table contributes
/// to its error, with the field itself in its place.
struct OnBoardAttitude {
  TaiTime t;
  Eigen::Quaterniond q_icrf_body;
  Eigen::Quaterniond q_icrf_body_with_field;
};

/// What the computer on board knows; `field` is the truth that the table is compared with.
struct OnBoardModel {
  KeplerOrbit orbit;
  FieldTable table;  ///< Table of the revolution from the epoch of the orbit on.
  MainField field;
};

/// Computes the attitude at each instant at which both sensors have measured; instants at which Sun
/// and field are in line have none.
/// @param suns, fields Measurements in order of time.
/// @return Error of the orbit or the field.
Expected<std::vector<OnBoardAttitude>> on_board_attitudes(const OnBoardModel& model,
                                                          const std::vector<SunDirection>& suns,
                                                          const std::vector<MagneticField>& fields);

}  // namespace spindrift
