/// @file
/// The reconstructed attitude from separation to the star fixes, as a kind of product.

#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "pipelines/reconstruction/separation.h"
#include "pipelines/three_axis/products.h"
#include "services/base/assessment_words.h"
#include "services/base/degrees.h"
#include "services/base/reasons_json.h"
#include "services/products/attitude.h"
#include "services/products/named.h"
#include "services/products/product_kind.h"
#include "services/products/sample_residual.h"

namespace spindrift {

/// Shared because its attitude history is long.
using ReconstructionProduct = std::shared_ptr<const ReconstructedSeparation>;

inline std::string_view method_of(const ReconstructionProduct& product) {
  return name_of(product->solution.method);
}

/// Converts a reconstructed event to the type of an attitude estimate made during a pass.
inline AttitudeEstimate estimate_of(const Reconstruction& solution,
                                    const ReconstructedEvent& event) {
  const ReconstructedAttitude& attitude = event.attitude;
  return {.t = attitude.t,
          .q_icrf_body = attitude.q_icrf_body,
          .rate_body_rad_s = attitude.rate_body_rad_s,
          .covariance_rad2 = attitude.covariance_rad2,
          .noise_sigma_rad = attitude.noise_sigma_rad(),
          .assessment = solution.assessment,
          .source = solution.method == ReconstructionMethod::Batch ? AttitudeSource::Batch
                                                                   : AttitudeSource::Sequential};
}

/// Makes a column about the launcher check; null when nothing was checked.
template <class Get>
constexpr auto launcher_column(std::string_view name, Get get) {
  return ProductColumn{name, [get](const ReconstructionProduct& product) {
                         const auto& check = product->launcher;
                         return check && *check ? std::optional{get(**check)} : std::nullopt;
                       }};
}

struct ReconstructionTable {
  static constexpr std::string_view kName = "reconstruction";
  static constexpr std::array<std::string_view, 1> kKey{"method"};

  using Product = ReconstructionProduct;
  /// Returns null when no bias was estimated.
  template <int kAxis>
  static std::optional<double> bias_rad_s(const Product& product) {
    const auto& bias = product->solution.bias;
    return bias ? std::optional{bias->rad_s[kAxis]} : std::nullopt;
  }
  template <int kAxis>
  static std::optional<double> bias_sigma_rad_s(const Product& product) {
    const auto& bias = product->solution.bias;
    return bias ? std::optional{std::sqrt(bias->covariance_rad2_s2(kAxis, kAxis))} : std::nullopt;
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"method", &method_of},
      ProductColumn{"t_tai_ns",
                    [](const Product& one) { return tai_ns(one->solution.history.back().t); }},
      ProductColumn{"quality",
                    [](const Product& one) { return name_of(one->solution.assessment.quality); }},
      ProductColumn{
          "reasons",
          [](const Product& one) { return to_json_text(one->solution.assessment.reasons); }},
      ProductColumn{"status",
                    [](const Product& one) { return sentence_of(one->solution.assessment); }},
      ProductColumn{"samples", &ReconstructedSeparation::samples},
      ProductColumn{"gyro_samples", [](const Product& one) { return one->solution.gyro.count; }},
      ProductColumn{"sun_vectors", [](const Product& one) { return one->solution.sun.count; }},
      ProductColumn{"star_fixes", [](const Product& one) { return one->solution.star.count; }},
      ProductColumn{"bias_x_rad_s", &bias_rad_s<0>}, ProductColumn{"bias_y_rad_s", &bias_rad_s<1>},
      ProductColumn{"bias_z_rad_s", &bias_rad_s<2>},
      ProductColumn{"bias_sigma_x_rad_s", &bias_sigma_rad_s<0>},
      ProductColumn{"bias_sigma_y_rad_s", &bias_sigma_rad_s<1>},
      ProductColumn{"bias_sigma_z_rad_s", &bias_sigma_rad_s<2>},
      launcher_column("launcher_angle_deg",
                      [](const LauncherCheck& c) { return c.difference.angle_rad * kDegPerRad; }),
      launcher_column("launcher_chi_square",
                      [](const LauncherCheck& c) { return c.difference.chi_square; }),
      launcher_column("launcher_chance", [](const LauncherCheck& c) { return c.chance; }));
};

struct ReconstructionEventTable {
  static constexpr std::string_view kName = "reconstruction_event";
  static constexpr std::array<std::string_view, 2> kKey{"method", "event"};

  struct Row {
    std::string_view method;
    ReconstructedEvent event;
    Euler312 in_icrf;
    std::optional<Euler312> in_orbit_frame;
  };
  static std::string_view group(const ReconstructionProduct& product) { return method_of(product); }
  static std::vector<Row> rows(const ReconstructionProduct& product) {
    std::vector<Row> rows;
    for (const ReconstructedEvent& event : product->solution.events) {
      rows.push_back({.method = method_of(product),
                      .event = event,
                      .in_icrf = euler312_of(event.attitude.q_icrf_body).angles,
                      .in_orbit_frame = std::nullopt});
    }
    for (std::size_t i = 0; i < product->in_orbit_frame.size(); ++i) {
      if (const auto& reading = product->in_orbit_frame[i]) {
        rows.at(i).in_orbit_frame = reading->angles;
      }
    }
    return rows;
  }
  template <int kAxis>
  static double rate_rad_s(const Row& row) {
    return row.event.attitude.rate_body_rad_s[kAxis];
  }
  template <int kRow, int kColumn>
  static double covariance_deg2(const Row& row) {
    return row.event.attitude.covariance_rad2(kRow, kColumn) * (kDegPerRad * kDegPerRad);
  }
  template <double Euler312::*kAngle>
  static double icrf_deg(const Row& row) {
    return row.in_icrf.*kAngle * kDegPerRad;
  }
  template <double Euler312::*kAngle>
  static std::optional<double> orbit_deg(const Row& row) {
    return row.in_orbit_frame ? std::optional{(*row.in_orbit_frame).*kAngle * kDegPerRad}
                              : std::nullopt;
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"method", &Row::method},
      ProductColumn{"event", [](const Row& row) { return name_of(row.event.event); }},
      ProductColumn{"t_tai_ns", [](const Row& row) { return tai_ns(row.event.attitude.t); }},
      ProductColumn{"found", [](const Row& row) { return row.event.found; }},
      ProductColumn{"qx", [](const Row& row) { return row.event.attitude.q_icrf_body.x(); }},
      ProductColumn{"qy", [](const Row& row) { return row.event.attitude.q_icrf_body.y(); }},
      ProductColumn{"qz", [](const Row& row) { return row.event.attitude.q_icrf_body.z(); }},
      ProductColumn{"qw", [](const Row& row) { return row.event.attitude.q_icrf_body.w(); }},
      ProductColumn{"rate_x_rad_s", &rate_rad_s<0>}, ProductColumn{"rate_y_rad_s", &rate_rad_s<1>},
      ProductColumn{"rate_z_rad_s", &rate_rad_s<2>},
      ProductColumn{"euler312_icrf_deg_1", &icrf_deg<&Euler312::phi_rad>},
      ProductColumn{"euler312_icrf_deg_2", &icrf_deg<&Euler312::theta_rad>},
      ProductColumn{"euler312_icrf_deg_3", &icrf_deg<&Euler312::psi_rad>},
      ProductColumn{"euler312_orbit_deg_1", &orbit_deg<&Euler312::phi_rad>},
      ProductColumn{"euler312_orbit_deg_2", &orbit_deg<&Euler312::theta_rad>},
      ProductColumn{"euler312_orbit_deg_3", &orbit_deg<&Euler312::psi_rad>},
      ProductColumn{"sigma_deg",
                    [](const Row& row) { return row.event.attitude.sigma_rad() * kDegPerRad; }},
      ProductColumn{
          "noise_sigma_deg",
          [](const Row& row) { return row.event.attitude.noise_sigma_rad() * kDegPerRad; }},
      ProductColumn{"cov_xx_deg2", &covariance_deg2<0, 0>},
      ProductColumn{"cov_xy_deg2", &covariance_deg2<0, 1>},
      ProductColumn{"cov_xz_deg2", &covariance_deg2<0, 2>},
      ProductColumn{"cov_yy_deg2", &covariance_deg2<1, 1>},
      ProductColumn{"cov_yz_deg2", &covariance_deg2<1, 2>},
      ProductColumn{"cov_zz_deg2", &covariance_deg2<2, 2>},
      ProductColumn{"bound_deg", [](const Row& row) {
                      const auto& bound_rad = row.event.bound_rad;
                      return bound_rad ? std::optional{*bound_rad * kDegPerRad} : std::nullopt;
                    }});
};

/// Rows of table `attitude`, which also holds those of filters (attitude.h).
struct ReconstructedAttitudeTable {
  static constexpr std::string_view kName = "attitude";
  static constexpr std::array<std::string_view, 2> kKey{"source", "t_tai_ns"};
  static constexpr bool kSaysWhenAnnounced = true;

  struct Row {
    std::string_view source;
    ReconstructedAttitude attitude;
    std::string_view quality;
    std::string reasons;
    std::string status;
  };
  static std::string_view group(const ReconstructionProduct& product) { return method_of(product); }
  static std::vector<Row> rows(const ReconstructionProduct& product) {
    const Assessment& assessment = product->solution.assessment;
    const std::string reasons = to_json_text(assessment.reasons);
    const std::string status = sentence_of(assessment);
    std::vector<Row> rows;
    for (const ReconstructedAttitude& attitude : product->solution.history) {
      rows.push_back({.source = method_of(product),
                      .attitude = attitude,
                      .quality = name_of(assessment.quality),
                      .reasons = reasons,
                      .status = status});
    }
    return rows;
  }
  template <int kRow, int kColumn>
  static double covariance_deg2(const Row& row) {
    return row.attitude.covariance_rad2(kRow, kColumn) * (kDegPerRad * kDegPerRad);
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"source", &Row::source},
      ProductColumn{"t_tai_ns", [](const Row& row) { return tai_ns(row.attitude.t); }},
      ProductColumn{"qx", [](const Row& row) { return row.attitude.q_icrf_body.x(); }},
      ProductColumn{"qy", [](const Row& row) { return row.attitude.q_icrf_body.y(); }},
      ProductColumn{"qz", [](const Row& row) { return row.attitude.q_icrf_body.z(); }},
      ProductColumn{"qw", [](const Row& row) { return row.attitude.q_icrf_body.w(); }},
      ProductColumn{"rate_x_rad_s",
                    [](const Row& row) { return row.attitude.rate_body_rad_s.x(); }},
      ProductColumn{"rate_y_rad_s",
                    [](const Row& row) { return row.attitude.rate_body_rad_s.y(); }},
      ProductColumn{"rate_z_rad_s",
                    [](const Row& row) { return row.attitude.rate_body_rad_s.z(); }},
      ProductColumn{"sigma_deg",
                    [](const Row& row) { return row.attitude.sigma_rad() * kDegPerRad; }},
      ProductColumn{"noise_sigma_deg",
                    [](const Row& row) { return row.attitude.noise_sigma_rad() * kDegPerRad; }},
      ProductColumn{"cov_xx_deg2", &covariance_deg2<0, 0>},
      ProductColumn{"cov_xy_deg2", &covariance_deg2<0, 1>},
      ProductColumn{"cov_xz_deg2", &covariance_deg2<0, 2>},
      ProductColumn{"cov_yy_deg2", &covariance_deg2<1, 1>},
      ProductColumn{"cov_yz_deg2", &covariance_deg2<1, 2>},
      ProductColumn{"cov_zz_deg2", &covariance_deg2<2, 2>}, ProductColumn{"quality", &Row::quality},
      ProductColumn{"reasons", &Row::reasons}, ProductColumn{"status", &Row::status});
};

/// Rows of table `sample_residual`, which also holds those of filters (sample_residual.h).
struct ReconstructionResidualTable {
  static constexpr std::string_view kName = "sample_residual";
  static constexpr std::array<std::string_view, 3> kKey{"estimator", "t_tai_ns", "kind"};
  static constexpr bool kOfResiduals = true;

  static std::string_view group(const ReconstructionProduct& product) { return method_of(product); }
  static std::vector<SampleObservation> rows(const ReconstructionProduct& product) {
    const AttitudeSource estimator = product->solution.method == ReconstructionMethod::Batch
                                         ? AttitudeSource::Batch
                                         : AttitudeSource::Sequential;
    std::vector<SampleObservation> rows;
    for (const Observation& said : product->solution.said) {
      rows.push_back({.estimator = estimator, .said = said});
    }
    return rows;
  }
  static constexpr auto kColumns = SampleResidualTable::kColumns;
};

template <>
struct ProductKind<ReconstructionProduct> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<ReconstructionTable, ReconstructionEventTable,
                            ReconstructedAttitudeTable, ReconstructionResidualTable>;
  static constexpr bool kStays = true;

  static constexpr bool is_announced(const ReconstructionProduct& /*product*/) { return true; }
  static std::string_view instance(const ReconstructionProduct& product) {
    return method_of(product);
  }
  static std::int64_t number(const ReconstructionProduct& product) { return product->samples; }
  static constexpr bool is_settled(const ReconstructionProduct& /*product*/) { return true; }

  /// Returns the events, T1 last, since the bus keeps a method's last one for late subscribers.
  static std::vector<AttitudeEstimate> announced_as(const ReconstructionProduct& product) {
    const Reconstruction& solution = product->solution;
    std::vector<AttitudeEstimate> events;
    for (auto event = solution.events.rbegin(); event != solution.events.rend(); ++event) {
      events.push_back(estimate_of(solution, *event));
    }
    return events;
  }

  /// Restores only what is announced.
  using Parts = ReconstructionEventTable;
  template <class Row, class EventRows>
  static ReconstructionProduct from_row(const Row& row, const EventRows& for_each_event) {
    ReconstructedSeparation separation{
        .solution = {.method = named(row.text("method"), ReconstructionMethod::Sequential),
                     .events = {},
                     .history = {},
                     .bias = std::nullopt,
                     .misalignment = std::nullopt,
                     .open_bias = {},
                     .gyro = {},
                     .sun = {},
                     .star = {},
                     .said = {},
                     .assessment = {.quality = named(row.text("quality"), Quality::Lost),
                                    .reasons = reasons_of(row.text("reasons"))},
                     .iterations = 0},
        .in_orbit_frame = {},
        .launcher = std::nullopt,
        .samples = row.integer("samples")};
    for_each_event(
        [&](const auto& event) { separation.solution.events.push_back(event_of(event)); });
    return std::make_shared<const ReconstructedSeparation>(std::move(separation));
  }

 private:
  template <class Row>
  static ReconstructedEvent event_of(const Row& row) {
    return {.event = named(row.text("event"), SeparationEvent::FirstStarFix),
            .found = row.integer("found") != 0,
            .attitude = {
                .t = tai_from_ns(row.integer("t_tai_ns")),
                .q_icrf_body = {row.real("qw"), row.real("qx"), row.real("qy"), row.real("qz")},
                .rate_body_rad_s = {row.real("rate_x_rad_s"), row.real("rate_y_rad_s"),
                                    row.real("rate_z_rad_s")},
                .covariance_rad2 = attitude_covariance_rad2_of(row),
                // Alike about all axes; announced is the root of the trace.
                .noise_covariance_rad2 = std::pow(row.real("noise_sigma_deg") * kRadPerDeg, 2) /
                                         3.0 * Eigen::Matrix3d::Identity(),
                .rate_covariance_rad2_s2 = Eigen::Matrix3d::Zero()}};
  }
};

}  // namespace spindrift
