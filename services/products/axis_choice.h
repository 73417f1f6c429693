/// @file
/// Which axis a pass has taken, as a kind of product.

#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <tuple>

#include "pipelines/spin/types/products.h"
#include "services/products/axis_columns.h"
#include "services/products/product_kind.h"

namespace spindrift {

struct AxisChoiceTable {
  static constexpr std::string_view kName = "axis_choice";
  static constexpr std::array<std::string_view, 1> kKey{"run_id"};

  static std::optional<PlaceDeg> other(const AxisChoice& choice) {
    return choice.other_icrf ? std::optional{place_deg(*choice.other_icrf)} : std::nullopt;
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"ra_deg",
                    [](const AxisChoice& one) { return place_deg(one.axis_icrf).ra_deg; }},
      ProductColumn{"dec_deg",
                    [](const AxisChoice& one) { return place_deg(one.axis_icrf).dec_deg; }},
      ProductColumn{"other_ra_deg",
                    [](const AxisChoice& one) {
                      const auto place = other(one);
                      return place ? std::optional{place->ra_deg} : std::nullopt;
                    }},
      ProductColumn{"other_dec_deg",
                    [](const AxisChoice& one) {
                      const auto place = other(one);
                      return place ? std::optional{place->dec_deg} : std::nullopt;
                    }},
      ProductColumn{"delta_chi_square",
                    [](const AxisChoice& one) {
                      return one.other_icrf ? std::optional{one.delta_chi_square} : std::nullopt;
                    }},
      ProductColumn{"settled_by", [](const AxisChoice& one) { return one.settled_by; }});
};

template <>
struct ProductKind<AxisChoice> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  static constexpr bool kStays = true;  ///< It is of a whole pass.
  using Tables = std::tuple<AxisChoiceTable>;
};

}  // namespace spindrift
