/// @file
/// A sample of a three-axis spacecraft that its pass left out, as a kind of product.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>

#include "pipelines/three_axis/products.h"
#include "services/base/degrees.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// Returns the factor to the stored unit: rates are stored in deg/s, other values are pure numbers.
inline double unit_of_test(Rejection test) {
  const bool is_rate = test == Rejection::Saturated || test == Rejection::Outlier;
  return is_rate ? kDegPerRad : 1.0;
}
/// Returns the unit of the value in a gyro test.
inline std::string_view name_of_test_unit(Rejection test) {
  switch (test) {
    case Rejection::Saturated:
    case Rejection::Outlier:
      return "deg_s";
    case Rejection::Frozen:
      return "samples";
    default:
      return "times";
  }
}

struct RejectedSampleTable {
  static constexpr std::string_view kName = "rejected_sample";
  static constexpr std::array<std::string_view, 2> kKey{"t_tai_ns", "kind"};
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const RejectedSample& sample) { return tai_ns(sample.t); }},
      ProductColumn{"kind", [](const RejectedSample& sample) { return name_of(sample.kind); }},
      ProductColumn{"rejected_by",
                    [](const RejectedSample& sample) { return name_of(sample.rejected_by); }},
      ProductColumn{"squared_innovation",
                    [](const RejectedSample& sample) {
                      return sample.rejected_by == Rejection::Innovation
                                 ? std::optional{sample.failed.value().value}
                                 : std::nullopt;
                    }},
      ProductColumn{"value",
                    [](const RejectedSample& sample) {
                      return sample.failed ? std::optional{sample.failed->value *
                                                           unit_of_test(sample.rejected_by)}
                                           : std::nullopt;
                    }},
      ProductColumn{"limit", [](const RejectedSample& sample) {
                      return sample.failed ? std::optional{sample.failed->limit *
                                                           unit_of_test(sample.rejected_by)}
                                           : std::nullopt;
                    }});
  /// A sample that arrived twice keeps its first fate, so 'late' does not replace it.
  static constexpr std::string_view kReplaces = "excluded.rejected_by <> 'late'";
};

/// Residual row of a gyro sample, in the table of the other sensors' residuals (sample_residual.h).
struct GyroResidualTable {
  static constexpr std::string_view kName = "sample_residual";
  static constexpr std::array<std::string_view, 3> kKey{"estimator", "t_tai_ns", "kind"};
  static constexpr std::string_view kCondition =
      "kind = 'gyro' AND estimator NOT IN ('batch', 'sequential')";
  static constexpr bool kOfResiduals = true;

  using One = RejectedSample;
  static bool has_row(const One& sample) {
    return sample.kind == SampleKind::Gyro && sample.failed.has_value();
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"estimator", [](const One& /*one*/) { return name_of(AttitudeSource::Mekf); }},
      ProductColumn{"t_tai_ns", [](const One& one) { return tai_ns(one.t); }},
      ProductColumn{"kind", [](const One& one) { return name_of(one.kind); }},
      ProductColumn{"dof", [](const One& /*one*/) { return std::int64_t{1}; }},
      ProductColumn{"unit", [](const One& one) { return name_of_test_unit(one.rejected_by); }},
      ProductColumn{
          "residual_1",
          [](const One& one) { return one.failed->value * unit_of_test(one.rejected_by); }},
      ProductColumn{
          "limit",
          [](const One& one) { return one.failed->limit * unit_of_test(one.rejected_by); }},
      ProductColumn{"used", [](const One& /*one*/) { return false; }},
      ProductColumn{"rejected_by", [](const One& one) { return name_of(one.rejected_by); }});
};

template <>
struct ProductKind<RejectedSample> {
  /// Stored together with the attitudes around it, so that a restarted service continues after the
  /// last one.
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<RejectedSampleTable, GyroResidualTable>;
};

}  // namespace spindrift
