/// @file
/// A quantity measured in one revolution, as a kind of product.

#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <tuple>

#include "pipelines/spin/types/products.h"
#include "services/base/degrees.h"
#include "services/products/product_kind.h"
#include "services/products/pulse_use.h"

namespace spindrift {

struct SpinMeasurementTable {
  static constexpr std::string_view kName = "spin_measurement";
  static constexpr std::array<std::string_view, 2> kKey{"revolution", "quantity"};

  static constexpr bool is_time(const SpinMeasurement& measurement) {
    return measurement.quantity == SpinQuantity::Period;
  }
  /// Returns how far the value is off what was expected of it.
  static double off_of(const Observation& said) { return said.residual.value[0]; }
  /// Returns the largest deviation that passes the test.
  static double largest_of(const Observation& said) {
    return std::sqrt(said.limit) * said.residual.sigma[0];
  }
  static constexpr double to_unit(const SpinMeasurement& measurement) {
    return is_time(measurement) ? 1.0 : kDegPerRad;
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"revolution", &SpinMeasurement::revolution},
      ProductColumn{"quantity", [](const SpinMeasurement& one) { return name_of(one.quantity); }},
      ProductColumn{"value", [](const SpinMeasurement& one) { return one.value * to_unit(one); }},
      ProductColumn{
          "unit",
          [](const SpinMeasurement& one) { return std::string_view{is_time(one) ? "s" : "deg"}; }},
      ProductColumn{"sigma", [](const SpinMeasurement& one) { return one.sigma * to_unit(one); }},
      ProductColumn{"accepted", [](const SpinMeasurement& one) { return !one.rejected_by; }},
      ProductColumn{"rejected_by",
                    [](const SpinMeasurement& one) { return name_of(one.rejected_by); }},
      ProductColumn{"expected",
                    [](const SpinMeasurement& one) {
                      return one.said
                                 ? std::optional{(one.value - off_of(*one.said)) * to_unit(one)}
                                 : std::nullopt;
                    }},
      ProductColumn{"limit", [](const SpinMeasurement& one) {
                      return one.said ? std::optional{largest_of(*one.said) * to_unit(one)}
                                      : std::nullopt;
                    }});
};

template <>
struct ProductKind<SpinMeasurement> {
  static constexpr ProductWeight kWeight = ProductWeight::Detail;
  using Tables = std::tuple<SpinMeasurementTable>;
};

}  // namespace spindrift
