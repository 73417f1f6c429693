/// @file
/// Whether a product has a number that is none.

#pragma once

#include <optional>
#include <string_view>

#include "services/products/products.h"

namespace spindrift {

/// Where a product is not finite.
struct NotFinite {
  std::string_view table;
  std::string_view column;
};

/// The first such place in its rows. Empty: all its numbers are finite.
std::optional<NotFinite> not_finite(const Product& product);

}  // namespace spindrift
