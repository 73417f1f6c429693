/// @file
/// The use or rejection of an edge, as a kind of product.

#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>

#include "pipelines/spin/types/products.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// Returns the name of the test that left something out.
inline std::optional<std::string_view> name_of(const std::optional<Rejection>& rejected_by) {
  return rejected_by ? std::optional{name_of(*rejected_by)} : std::nullopt;
}

/// Makes a column about the edge's observation; null when it had none.
template <class Get>
constexpr auto said_column(std::string_view name, Get get) {
  return ProductColumn{name, [get](const PulseUse& use) {
                         return use.said ? std::optional{get(*use.said)} : std::nullopt;
                       }};
}
/// Makes a column about the residual, in ns; null when no edge was expected.
template <class Get>
constexpr auto residual_ns_column(std::string_view name, Get get) {
  return ProductColumn{
      name, [get](const PulseUse& use) {
        return use.said && use.said->residual.freedom > 0 && std::isfinite(get(use.said->residual))
                   ? std::optional{std::int64_t{std::llround(get(use.said->residual) * 1e9)}}
                   : std::nullopt;
      }};
}

struct PulseUseTable {
  static constexpr std::string_view kName = "pulse_use";
  static constexpr bool kOfSpacecraft = true;
  static constexpr std::array<std::string_view, 2> kKey{"t_tai_ns", "channel"};
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const PulseUse& use) { return tai_ns(use.pulse.t); }},
      ProductColumn{"channel", [](const PulseUse& use) { return name_of(use.pulse.channel); }},
      ProductColumn{"revolution", &PulseUse::revolution},
      ProductColumn{"accepted", [](const PulseUse& use) { return !use.rejected_by; }},
      ProductColumn{"rejected_by", [](const PulseUse& use) { return name_of(use.rejected_by); }},
      residual_ns_column("residual_ns", [](const Residual& residual) { return residual.value[0]; }),
      residual_ns_column("sigma_ns", [](const Residual& residual) { return residual.sigma[0]; }),
      said_column("residual_limit_milli",
                  [](const Observation& said) {
                    return std::int64_t{std::llround(1e3 * std::sqrt(said.limit))};
                  }),
      said_column("used", [](const Observation& said) { return !said.rejected_by; }));
  /// An edge that arrived twice keeps its first use, so 'late' does not replace it.
  static constexpr std::string_view kReplaces = "excluded.rejected_by IS NOT 'late'";
};

/// A table of its own, since few edges have a gap that is too narrow.
struct PulseGapTable {
  static constexpr std::string_view kName = "pulse_gap";
  static constexpr std::array<std::string_view, 2> kKey{"t_tai_ns", "channel"};

  static bool has_row(const PulseUse& use) { return use.gap.has_value(); }

  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const PulseUse& use) { return tai_ns(use.pulse.t); }},
      ProductColumn{"channel", [](const PulseUse& use) { return name_of(use.pulse.channel); }},
      ProductColumn{"gap_s", [](const PulseUse& use) { return use.gap->gap_s; }},
      ProductColumn{"least_gap_s", [](const PulseUse& use) { return use.gap->least_s; }});
};

template <>
struct ProductKind<PulseUse> {
  static constexpr ProductWeight kWeight = ProductWeight::Detail;
  using Tables = std::tuple<PulseUseTable, PulseGapTable>;
  static PulseUse without_residuals(PulseUse use) {
    use.said.reset();
    return use;
  }
};

}  // namespace spindrift
