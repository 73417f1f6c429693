/// @file
/// The attitude of a three-axis spacecraft, as a kind of product.
///
/// AttitudeEstimator gives at most ten estimates per second of telemetry time, besides those where
/// the pass begins, falls silent or loses the attitude. All of them are archived and announced;
/// nothing else thins them.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>

#include "pipelines/three_axis/products.h"
#include "services/base/assessment_words.h"
#include "services/base/degrees.h"
#include "services/base/reasons_json.h"
#include "services/products/named.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// Reads the columns cov_xx_deg2 to cov_zz_deg2.
template <class Row>
Eigen::Matrix3d attitude_covariance_rad2_of(const Row& row) {
  const double xy = row.real("cov_xy_deg2");
  const double xz = row.real("cov_xz_deg2");
  const double yz = row.real("cov_yz_deg2");
  Eigen::Matrix3d deg2;
  deg2 << row.real("cov_xx_deg2"), xy, xz, xy, row.real("cov_yy_deg2"), yz, xz, yz,
      row.real("cov_zz_deg2");
  return deg2 * (kRadPerDeg * kRadPerDeg);
}

struct AttitudeTable {
  static constexpr std::string_view kName = "attitude";
  static constexpr std::array<std::string_view, 2> kKey{"t_tai_ns", "source"};
  static constexpr bool kSaysWhenAnnounced = true;
  /// Excludes reconstructed attitudes, which are in the same table (reconstruction.h).
  static constexpr std::string_view kCondition = "source NOT IN ('batch', 'sequential')";

  template <int kRow, int kColumn>
  static double covariance_deg2(const AttitudeEstimate& estimate) {
    return estimate.covariance_rad2(kRow, kColumn) * (kDegPerRad * kDegPerRad);
  }
  template <int kAxis>
  static std::optional<double> rate_rad_s(const AttitudeEstimate& estimate) {
    const auto& rate_rad_s = estimate.rate_body_rad_s;
    return rate_rad_s ? std::optional{(*rate_rad_s)[kAxis]} : std::nullopt;
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const AttitudeEstimate& one) { return tai_ns(one.t); }},
      ProductColumn{"source", [](const AttitudeEstimate& one) { return name_of(one.source); }},
      ProductColumn{"qx", [](const AttitudeEstimate& one) { return one.q_icrf_body.x(); }},
      ProductColumn{"qy", [](const AttitudeEstimate& one) { return one.q_icrf_body.y(); }},
      ProductColumn{"qz", [](const AttitudeEstimate& one) { return one.q_icrf_body.z(); }},
      ProductColumn{"qw", [](const AttitudeEstimate& one) { return one.q_icrf_body.w(); }},
      ProductColumn{"rate_x_rad_s", &rate_rad_s<0>}, ProductColumn{"rate_y_rad_s", &rate_rad_s<1>},
      ProductColumn{"rate_z_rad_s", &rate_rad_s<2>},
      ProductColumn{"sigma_deg",
                    [](const AttitudeEstimate& one) { return one.sigma_rad() * kDegPerRad; }},
      ProductColumn{"noise_sigma_deg",
                    [](const AttitudeEstimate& one) { return one.noise_sigma_rad * kDegPerRad; }},
      ProductColumn{"cov_xx_deg2", &covariance_deg2<0, 0>},
      ProductColumn{"cov_xy_deg2", &covariance_deg2<0, 1>},
      ProductColumn{"cov_xz_deg2", &covariance_deg2<0, 2>},
      ProductColumn{"cov_yy_deg2", &covariance_deg2<1, 1>},
      ProductColumn{"cov_yz_deg2", &covariance_deg2<1, 2>},
      ProductColumn{"cov_zz_deg2", &covariance_deg2<2, 2>},
      ProductColumn{"quality",
                    [](const AttitudeEstimate& one) { return name_of(one.assessment.quality); }},
      ProductColumn{
          "reasons",
          [](const AttitudeEstimate& one) { return to_json_text(one.assessment.reasons); }},
      ProductColumn{"status",
                    [](const AttitudeEstimate& one) { return sentence_of(one.assessment); }},
      ProductColumn{"squared_innovations",
                    [](const AttitudeEstimate& one) { return one.innovations.squared; }},
      ProductColumn{"innovation_freedom",
                    [](const AttitudeEstimate& one) { return one.innovations.freedom; }});
};

/// The gyro bias of estimates that include one.
struct GyroBiasTable {
  static constexpr std::string_view kName = "gyro_bias";
  static constexpr std::array<std::string_view, 2> kKey{"t_tai_ns", "estimator"};

  static bool has_row(const AttitudeEstimate& estimate) { return estimate.gyro_bias.has_value(); }
  template <int kAxis>
  static double bias_deg_s(const AttitudeEstimate& estimate) {
    return estimate.gyro_bias->rad_s[kAxis] * kDegPerRad;
  }
  template <int kAxis>
  static double sigma_deg_s(const AttitudeEstimate& estimate) {
    return std::sqrt(estimate.gyro_bias->covariance_rad2_s2(kAxis, kAxis)) * kDegPerRad;
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const AttitudeEstimate& one) { return tai_ns(one.t); }},
      ProductColumn{"estimator", [](const AttitudeEstimate& one) { return name_of(one.source); }},
      ProductColumn{"bx_deg_s", &bias_deg_s<0>}, ProductColumn{"by_deg_s", &bias_deg_s<1>},
      ProductColumn{"bz_deg_s", &bias_deg_s<2>}, ProductColumn{"sigma_bx_deg_s", &sigma_deg_s<0>},
      ProductColumn{"sigma_by_deg_s", &sigma_deg_s<1>},
      ProductColumn{"sigma_bz_deg_s", &sigma_deg_s<2>});
};

template <>
struct ProductKind<AttitudeEstimate> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<AttitudeTable, GyroBiasTable>;

  static constexpr const char* kTopic = "spindrift/attitude";
  static constexpr bool is_announced(const AttitudeEstimate& /*estimate*/) { return true; }
  static std::string_view instance(const AttitudeEstimate& estimate) {
    return name_of(estimate.source);
  }
  static std::int64_t number(const AttitudeEstimate& estimate) { return tai_ns(estimate.t); }
  static constexpr bool is_settled(const AttitudeEstimate& /*estimate*/) { return true; }

  template <class Row>
  static AttitudeEstimate from_row(const Row& row) {
    AttitudeEstimate estimate{
        .t = tai_from_ns(row.integer("t_tai_ns")),
        .q_icrf_body = {row.real("qw"), row.real("qx"), row.real("qy"), row.real("qz")},
        .rate_body_rad_s = std::nullopt,
        .covariance_rad2 = attitude_covariance_rad2_of(row),
        .noise_sigma_rad = row.real("noise_sigma_deg") * kRadPerDeg,
        .assessment = {.quality = named(row.text("quality"), Quality::Lost),
                       .reasons = reasons_of(row.text("reasons"))},
        .source = named(row.text("source"), AttitudeSource::Sequential),
        .innovations = {.squared = row.real("squared_innovations"),
                        .freedom = row.integer("innovation_freedom")}};
    if (row.has("rate_x_rad_s")) {
      estimate.rate_body_rad_s = Eigen::Vector3d{row.real("rate_x_rad_s"), row.real("rate_y_rad_s"),
                                                 row.real("rate_z_rad_s")};
    }
    return estimate;
  }
};

}  // namespace spindrift
