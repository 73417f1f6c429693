/// @file
/// Knots of a table of the field that are closer where the field bends: the K-weighted U-chord
/// curvature (Liu 2019, par. 2, eq. 6 to 9).
///
/// The curvature is that of the graph of each axis against true anomaly in rad, in units of its own
/// range; the three are added, since a table has one set of knots. The
/// paper takes the curvature of a polar graph: its own bend is that of the circle, which is not the
/// field's, and with it no K is better than equal steps.

#pragma once

#include <vector>

#include "pipelines/geomagnetism/tables/field_table.h"

namespace spindrift {

struct CurvatureKnots {
  std::vector<double> places;  ///< Places of the knots, rising from 0 to 1 over the revolution.
  double weight;               ///< K, the weight of equal steps beside the curvature.
};

/// Returns the U-chord curvature of each sample, all axes together (eq. 6), without its sign.
std::vector<double> chord_curvature(const SampledField& field_nt);

/// Returns the knots for a weight K: between two of them lies the same sum of curvature and K
/// (eq. 8).
/// @param curvature Curvature of samples at equal steps.
std::vector<double> knots_by_curvature(const std::vector<double>& curvature, double weight,
                                       int points);

/// Returns the mean absolute error of linear interpolation between knots, all axes together, nT
/// (eq. 9).
double mean_error_nt(const SampledField& field_nt, const std::vector<double>& places);

/// Returns the weights K that are tried, rising; with the largest the knots are nearly equal steps.
std::vector<double> studied_weights();

/// Returns the knots of the K with the least mean error.
CurvatureKnots curvature_knots(const SampledField& field_nt, int points);

}  // namespace spindrift
