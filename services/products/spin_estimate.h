/// @file
/// Spin axis and rate by one estimator, as a kind of product.

#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "pipelines/spin/types/products.h"
#include "services/base/assessment_words.h"
#include "services/base/reasons_json.h"
#include "services/products/axis_columns.h"
#include "services/products/named.h"
#include "services/products/product_kind.h"

namespace spindrift {

struct SpinEstimateTable {
  static constexpr std::string_view kName = "spin_estimate";
  static constexpr std::array<std::string_view, 2> kKey{"t_tai_ns", "estimator"};
  static constexpr bool kSaysWhenAnnounced = true;

  using Axis = AxisColumns<SpinEstimate>;
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const SpinEstimate& estimate) { return tai_ns(estimate.t); }},
      ProductColumn{"estimator",
                    [](const SpinEstimate& estimate) { return name_of(estimate.estimator); }},
      ProductColumn{"ra_deg", &Axis::ra_deg}, ProductColumn{"dec_deg", &Axis::dec_deg},
      ProductColumn{"sigma_deg", &Axis::sigma_deg},
      ProductColumn{"noise_sigma_deg", &Axis::noise_sigma_deg},
      ProductColumn{"cov_east_east_deg2", &Axis::covariance_deg2<0, 0>},
      ProductColumn{"cov_east_north_deg2", &Axis::covariance_deg2<0, 1>},
      ProductColumn{"cov_north_north_deg2", &Axis::covariance_deg2<1, 1>},
      ProductColumn{
          "spin_rate_rpm",
          [](const SpinEstimate& estimate) { return estimate.spin_rate_rad_s * kRpmPerRad_s; }},
      ProductColumn{"sigma_rpm",
                    [](const SpinEstimate& estimate) {
                      return estimate.spin_rate_sigma_rad_s * kRpmPerRad_s;
                    }},
      ProductColumn{
          "quality",
          [](const SpinEstimate& estimate) { return name_of(estimate.assessment.quality); }},
      ProductColumn{
          "reasons",
          [](const SpinEstimate& estimate) { return to_json_text(estimate.assessment.reasons); }},
      ProductColumn{"status",
                    [](const SpinEstimate& estimate) { return sentence_of(estimate.assessment); }});
};

template <>
struct ProductKind<SpinEstimate> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<SpinEstimateTable>;

  static constexpr const char* kTopic = "spindrift/spin_estimate";
  static constexpr bool is_announced(const SpinEstimate& /*estimate*/) { return true; }
  static std::string_view instance(const SpinEstimate& estimate) {
    return name_of(estimate.estimator);
  }
  static std::int64_t number(const SpinEstimate& estimate) { return tai_ns(estimate.t); }
  static constexpr bool is_settled(const SpinEstimate& /*estimate*/) { return true; }

  template <class Row>
  static SpinEstimate from_row(const Row& row) {
    return {.t = tai_from_ns(row.integer("t_tai_ns")),
            .estimator = named(row.text("estimator"), SpinEstimator::Batch),
            .axis_icrf = axis_icrf_from(row.real("ra_deg"), row.real("dec_deg")),
            .covariance_rad2 = covariance_rad2_of(row),
            .spin_rate_rad_s = row.real("spin_rate_rpm") / kRpmPerRad_s,
            .spin_rate_sigma_rad_s = row.real("sigma_rpm") / kRpmPerRad_s,
            .assessment = {.quality = named(row.text("quality"), Quality::Lost),
                           .reasons = reasons_of(row.text("reasons"))},
            .alignment_rad2 = alignment_rad2_of(row)};
  }
};

}  // namespace spindrift
