/// @file
/// A revolution of the body, as a kind of product.

#pragma once

#include <array>
#include <string_view>
#include <tuple>

#include "pipelines/spin/types/products.h"
#include "services/products/product_kind.h"

namespace spindrift {

struct RevolutionTable {
  static constexpr std::string_view kName = "revolution";
  static constexpr std::array<std::string_view, 1> kKey{"revolution"};
  static constexpr auto kColumns = columns(
      ProductColumn{"revolution", &RevolutionProduct::revolution},
      ProductColumn{"t_tai_ns", [](const RevolutionProduct& turn) { return tai_ns(turn.t_sun1); }},
      ProductColumn{"period_s", &RevolutionProduct::period_s});
};

template <>
struct ProductKind<RevolutionProduct> {
  static constexpr ProductWeight kWeight = ProductWeight::Detail;
  using Tables = std::tuple<RevolutionTable>;
};

}  // namespace spindrift
