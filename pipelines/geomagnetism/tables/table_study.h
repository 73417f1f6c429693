/// @file
/// This study shows what a table of the field costs an attitude from Sun and field: the Monte Carlo
/// of Liu 2019, par. 3.2 and 3.3.
///
/// The body stands in the orbit frame and measures Sun and field with noise. From each measurement
/// the two-vector attitude is computed twice, with the field itself and with the table's as the
/// reference. The measurement is the same, so that the difference is the table's alone.

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/geomagnetism/tables/field_table.h"
#include "pipelines/geomagnetism/tables/revolution_field.h"

namespace spindrift {

/// Numbers of points that a study compares.
inline constexpr std::array kStudiedPoints{20, 30, 40, 60, 80, 100, 120, 150};
/// Number of points that the paper chooses.
inline constexpr int kChosenPoints = 80;

/// One place of the revolution: the truth, and the Sun.
struct StudyPlace {
  double behind_first_rad;
  Eigen::Vector3d field_orbit_nt;
  Eigen::Vector3d sun_orbit;  ///< Unit vector.
};

struct StudiedTable {
  TableKind kind;
  int points;
  std::size_t bytes;
  TableErrors errors;
  /// Mean over the revolution of the root mean square difference of the attitude from the one with
  /// the field itself, of each Euler angle phi, theta, psi (eq. 13 and 14).
  Eigen::Vector3d armse_rad;
};

/// Attitude errors at one place in one run, Euler angles phi, theta, psi.
struct StudiedAttitude {
  double behind_first_rad;
  Eigen::Vector3d with_field_rad;  ///< Error with the field itself: of the sensors alone.
  Eigen::Vector3d with_table_rad;  ///< Error with the table of `kChosenPoints` by curvature.
};

/// Largest attitude errors of all runs, Euler angles phi, theta, psi.
struct MostOff {
  Eigen::Vector3d with_field_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d with_table_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_table_rad = Eigen::Vector3d::Zero();  ///< Largest difference of the two.
};

/// Mean error of a table of `kChosenPoints` by the weight K of equal steps (eq. 9).
struct StudiedWeight {
  double weight;
  double mean_error_nt;
};

struct FieldStudy {
  std::vector<StudyPlace> places;
  std::vector<StudiedTable> tables;
  std::vector<StudiedWeight> weights;
  double uniform_error_nt;                 ///< Mean error of equal steps, as `weights`.
  std::vector<double> knots_rad;           ///< Knots of the table of `kChosenPoints` by curvature.
  std::vector<StudiedAttitude> attitudes;  ///< Attitudes of the first run.
  MostOff most;
  int places_in_line;  ///< Places left out, where Sun and field are in line and give no attitude.
};

/// Studies tables along the revolution of an orbit from the epoch of its elements on.
/// @return What the field returns.
Expected<FieldStudy> study_tables(const KeplerOrbit& orbit, const MainField& field);

}  // namespace spindrift
