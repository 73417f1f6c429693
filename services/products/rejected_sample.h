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

/// What a test finds is stored in: rates in deg/s, all else is a number.
inline double unit_of_test(Rejection test) {
  const bool is_rate = test == Rejection::Saturated || test == Rejection::Outlier;
  return is_rate ? kDegPerRad : 1.0;
}
/// Of the gyro.
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
  /// A sample that is late is not said to be so when something else has become of it: it arrived
  /// twice.
  static constexpr std::string_view kReplaces = "excluded.rejected_by <> 'late'";
};

/// Of a gyro sample, beside what the samples of the other sensors said (sample_residual.h).
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
  /// Stored with the attitudes between which it lies, so that a restarted service goes on where the
  /// last of them is.
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<RejectedSampleTable, GyroResidualTable>;
};

}  // namespace spindrift
