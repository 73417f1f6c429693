/// @file
/// Chebyshev coefficients of the field along a revolution, by least squares.
///
/// Up to 150 coefficients are fitted to samples at equal steps of anomaly, as the errors of tables
/// are measured. Equal steps determine no more of them, about twice the square root of the number
/// of samples. Beyond, the samples are at Chebyshev nodes: there the polynomials are orthogonal, so
/// that least squares is a discrete cosine transform.

#pragma once

#include <Eigen/Core>

#include "pipelines/geomagnetism/tables/field_table.h"

namespace spindrift {

/// @param count Number of coefficients, at least one.
/// @return c_k of sum c_k T_k(x), x = anomaly behind the first / pi - 1; a row each, nT. What
///         `field` returns.
Expected<Eigen::MatrixX3d> chebyshev_coefficients(const FieldAlong& field, int count);

}  // namespace spindrift
