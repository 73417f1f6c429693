/// @file
/// What to do about a lost attitude, as a kind of product.

#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/three_axis/products.h"
#include "services/base/advisory_words.h"
#include "services/base/degrees.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// Returns an object with the voice of each sensor on board.
inline nlohmann::json json_of(const SensorVoices& sensors) {
  nlohmann::json object = nlohmann::json::object();
  for (std::size_t kind = 0; kind < sensors.size(); ++kind) {
    if (const auto& voice = sensors.at(kind)) {
      object[std::string{name_of(static_cast<SampleKind>(kind))}] = name_of(*voice);
    }
  }
  return object;
}

struct AdvisoryTable {
  static constexpr std::string_view kName = "advisory";
  static constexpr std::array<std::string_view, 1> kKey{"t_tai_ns"};

  using One = Advisory;
  /// @name Null while there is no attitude
  /// @{
  template <int kElement>
  static std::optional<double> quaternion(const One& one) {
    return one.attitude ? std::optional{one.attitude->q_icrf_body.coeffs()[kElement]}
                        : std::nullopt;
  }
  static std::optional<double> sigma_deg(const One& one) {
    return one.attitude ? std::optional{one.attitude->sigma_rad() * kDegPerRad} : std::nullopt;
  }
  template <int kAxis>
  static std::optional<double> rate_rad_s(const One& one) {
    return one.attitude && one.attitude->rate_body_rad_s
               ? std::optional{(*one.attitude->rate_body_rad_s)[kAxis]}
               : std::nullopt;
  }
  /// @}
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const One& one) { return tai_ns(one.t); }},
      ProductColumn{"sensors", [](const One& one) { return json_of(one.sensors).dump(); }},
      ProductColumn{"qx", &quaternion<0>}, ProductColumn{"qy", &quaternion<1>},
      ProductColumn{"qz", &quaternion<2>}, ProductColumn{"qw", &quaternion<3>},
      ProductColumn{"sigma_deg", &sigma_deg}, ProductColumn{"rate_x_rad_s", &rate_rad_s<0>},
      ProductColumn{"rate_y_rad_s", &rate_rad_s<1>}, ProductColumn{"rate_z_rad_s", &rate_rad_s<2>},
      ProductColumn{"may_control", &One::may_control},
      ProductColumn{"says", [](const One& one) { return sentence_of(one); }});
};

template <>
struct ProductKind<Advisory> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<AdvisoryTable>;
};

}  // namespace spindrift
