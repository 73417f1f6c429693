/// @file
/// Columns for a spin axis with its covariance, and back.

#pragma once

#include <Eigen/Core>

#include "pipelines/spin/types/products.h"
#include "services/base/degrees.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// Column values of a product with an axis and covariance. East and north span the tangent plane at
/// the axis.
template <class Product>
struct AxisColumns {
  static double ra_deg(const Product& product) { return place_deg(product.axis_icrf).ra_deg; }
  static double dec_deg(const Product& product) { return place_deg(product.axis_icrf).dec_deg; }
  static double sigma_deg(const Product& product) {
    return spindrift::sigma_deg(product.covariance_rad2);
  }
  static double noise_sigma_deg(const Product& product) {
    return noise_sigma_rad(product) * kDegPerRad;
  }
  template <int kRow, int kColumn>
  static double covariance_deg2(const Product& product) {
    return product.covariance_rad2(kRow, kColumn) * (kDegPerRad * kDegPerRad);
  }
};

inline Eigen::Vector3d axis_icrf_from(double ra_deg, double dec_deg) {
  return direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg});
}

/// Reads the columns cov_east_east_deg2, cov_east_north_deg2 and cov_north_north_deg2.
template <class Row>
Eigen::Matrix2d covariance_rad2_of(const Row& row) {
  const double east_north = row.real("cov_east_north_deg2");
  Eigen::Matrix2d deg2;
  deg2 << row.real("cov_east_east_deg2"), east_north, east_north, row.real("cov_north_north_deg2");
  return deg2 * (kRadPerDeg * kRadPerDeg);
}

/// Reads the part of the covariance that errors of the mission file make, in the shape of the
/// total: the archive holds its size.
template <class Row>
Eigen::Matrix2d alignment_rad2_of(const Row& row) {
  const Eigen::Matrix2d total_rad2 = covariance_rad2_of(row);
  const double noise_deg = row.real("noise_sigma_deg");
  const double total_deg = sigma_deg(total_rad2);
  return noise_deg < total_deg
             ? Eigen::Matrix2d{total_rad2 * (1.0 - noise_deg * noise_deg / (total_deg * total_deg))}
             : Eigen::Matrix2d{Eigen::Matrix2d::Zero()};
}

}  // namespace spindrift
