/// @file
/// That a sample came with more than one value, as a kind of product.

#pragma once

#include <optional>
#include <tuple>

#include "pipelines/time/sample_contradiction.h"
#include "services/products/not_finite.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// Its table is written with the samples, whose values it has: this tells which of them count
/// (archive/batch_writer.h).
template <>
struct ProductKind<SampleContradiction> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  static constexpr bool kStays = true;
  using Tables = std::tuple<>;
};

/// It has no number of its own.
inline std::optional<NotFinite> not_finite(const SampleContradiction& /*contradiction*/) {
  return std::nullopt;
}

}  // namespace spindrift
