/// @file
/// The comparison of a channel with the ground model, as a kind of product.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/ground_model/comparison/departure_watch.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// Makes a column about the residuals; null when there was no sample.
constexpr auto residual_column(std::string_view name, double (ResidualStatistics::*get)() const) {
  return ProductColumn{name, [get](const ChannelComparison& compared) {
                         const ResidualStatistics& residuals = compared.residuals;
                         return residuals.count() > 0 ? std::optional{(residuals.*get)()}
                                                      : std::nullopt;
                       }};
}

/// Makes a column about the departure from the model; null when there was none.
template <class Get>
constexpr auto departure_column(std::string_view name, Get get) {
  return ProductColumn{name, [get](const ChannelComparison& compared) {
                         const auto& departure = compared.departure;
                         return departure ? std::optional{get(*departure)} : std::nullopt;
                       }};
}

struct ModelComparisonTable {
  static constexpr std::string_view kName = "model_comparison";
  static constexpr std::array<std::string_view, 1> kKey{"channel"};
  static constexpr auto kColumns = columns(
      ProductColumn{"channel",
                    [](const ChannelComparison& compared) { return compared.channel.name; }},
      ProductColumn{
          "unit",
          [](const ChannelComparison& compared) { return std::string{compared.channel.unit}; }},
      ProductColumn{"samples",
                    [](const ChannelComparison& compared) { return compared.residuals.count(); }},
      ProductColumn{"outside", &ChannelComparison::outside},
      residual_column("mean", &ResidualStatistics::mean),
      residual_column("sigma", &ResidualStatistics::sigma),
      residual_column("rms", &ResidualStatistics::rms),
      residual_column("most", &ResidualStatistics::most),
      residual_column("normalised_rms", &ResidualStatistics::normalised_rms),
      departure_column("departed_tai_ns",
                       [](const Evidence& departure) { return tai_ns(departure.since); }),
      departure_column("departed_value", [](const Evidence& departure) { return departure.value; }),
      departure_column("departed_limit", [](const Evidence& departure) { return departure.limit; }),
      departure_column("departed_unit",
                       [](const Evidence& departure) { return std::string{departure.unit}; }));
};

template <>
struct ProductKind<ChannelComparison> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  static constexpr bool kStays = true;  ///< The comparison covers a whole pass.
  using Tables = std::tuple<ModelComparisonTable>;
};

}  // namespace spindrift
