/// @file
/// Tables of the field along one revolution, small enough for the controller of a femtosatellite.
///
///     uniform    the field at equal steps of true anomaly, both ends stored: the field is not
///                periodic, since the Earth has turned (Liu 2019, par. 1.3)
///     curvature  the field at knots that are closer where it bends (curvature_knots.h), and the
///                knots, which the paper does not count
///     chebyshev  coefficients c_k of sum c_k T_k(x), x = (anomaly - first)/pi - 1
///                (chebyshev_fit.h)
///
/// Numbers are stored as float32; lookup computes in double.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

enum class TableKind { Uniform, Curvature, Chebyshev };
inline constexpr std::array kTableKinds{TableKind::Uniform, TableKind::Curvature,
                                        TableKind::Chebyshev};
std::string_view name_of(TableKind kind);
/// Returns empty for another name.
std::optional<TableKind> table_kind(std::string_view name);

inline constexpr int kFewestTablePoints = 4;
inline constexpr int kMostTablePoints = 100'000;

struct FieldTable {
  TableKind kind = TableKind::Uniform;
  float first_anomaly_rad = 0.0F;
  std::vector<Eigen::Vector3f> rows = {};  ///< Fields at the knots, or coefficients; nT.
  std::vector<float> knots_rad = {};       ///< Anomalies behind the first of a table by curvature.

  /// Returns the size of the table on board: first anomaly, number of rows, rows, knots.
  std::size_t bytes() const { return 8 + 12 * rows.size() + 4 * knots_rad.size(); }
};

/// Gives the field at an anomaly behind the first, 0 to 2 pi; nT.
using FieldAlong = std::function<Expected<Eigen::Vector3d>(double)>;

/// Makes the table of a kind with so many points, or coefficients.
/// @return InvalidInput for too few or too many points; what `field` returns.
Expected<FieldTable> make_table(const FieldAlong& field, TableKind kind, double first_anomaly_rad,
                                int points);

/// Returns the field that a table gives, nT.
/// @param behind_first_rad True anomaly behind the first, 0 to 2 pi; the ends hold beyond.
Eigen::Vector3d lookup(const FieldTable& table, double behind_first_rad);

/// Number of samples of a revolution by which tables are fitted and compared: one a second of the
/// paper's orbit.
inline constexpr int kRevolutionSamples = 5875;

/// The field at equal steps of anomaly over a revolution, both ends included; a column each, nT.
using SampledField = Eigen::Matrix3Xd;

/// @return What `field` returns.
Expected<SampledField> sampled(const FieldAlong& field, int samples = kRevolutionSamples);

struct TableErrors {
  Eigen::Vector3d mean_nt;  ///< Mean of the absolute error of each axis (Liu 2019, eq. 9).
  Eigen::Vector3d most_nt;
};
TableErrors errors_of(const FieldTable& table, const SampledField& truth_nt);

}  // namespace spindrift
