/// @file
/// Whether the sensors contradict each other, as a kind of product.

#pragma once

#include <optional>
#include <tuple>

#include "pipelines/observation/sensor_contradiction.h"
#include "services/products/not_finite.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// It has no table: alerts store what it says, and so do the reasons of the answers.
template <>
struct ProductKind<SensorsCompared> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  static constexpr bool kStays = true;
  using Tables = std::tuple<>;
};

/// It contains numbers only if it was found by them.
inline std::optional<NotFinite> not_finite(const SensorsCompared& /*sensors*/) {
  return std::nullopt;
}

}  // namespace spindrift
