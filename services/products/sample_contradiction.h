/// @file
/// A sample received with more than one value, as a kind of product.

#pragma once

#include <optional>
#include <tuple>

#include "pipelines/time/sample_contradiction.h"
#include "services/products/not_finite.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// It has no table of its own: its rows are written with the samples, and it selects those that
/// count (archive/batch_writer.h).
template <>
struct ProductKind<SampleContradiction> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  static constexpr bool kStays = true;
  using Tables = std::tuple<>;
};

/// A contradiction contains no number.
inline std::optional<NotFinite> not_finite(const SampleContradiction& /*contradiction*/) {
  return std::nullopt;
}

}  // namespace spindrift
