/// @file
/// That a gate opened or closed, as a kind of product.

#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>

#include "pipelines/observation/gate.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// Returns an object with the value of the last sample, what it was held against, hits and samples
/// of the window, its first sample, and what else the gate knew.
inline nlohmann::json evidence_of(const GateTransition& transition) {
  const GateRule rule = rule_of(transition.gate);
  nlohmann::json evidence{{"value", transition.value},
                          {"threshold", rule.threshold},
                          {"unit", rule.unit},
                          {"hits", transition.hits},
                          {"window", transition.window},
                          {"share", rule.share},
                          {"since_tai_ns", tai_ns(transition.since)}};
  for (const NamedValue& one : transition.more) {
    std::visit([&](const auto& value) { evidence[one.name] = value; }, one.value);
  }
  return evidence;
}

struct GateTransitionTable {
  static constexpr std::string_view kName = "gate_transition";
  static constexpr std::array<std::string_view, 2> kKey{"t_tai_ns", "gate"};

  using One = GateTransition;
  static constexpr auto kColumns =
      columns(ProductColumn{"t_tai_ns", [](const One& one) { return tai_ns(one.t); }},
              ProductColumn{"gate", [](const One& one) { return name_of(one.gate); }},
              ProductColumn{"open", [](const One& one) { return one.open; }},
              ProductColumn{"evidence", [](const One& one) { return evidence_of(one).dump(); }});
};

template <>
struct ProductKind<GateTransition> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<GateTransitionTable>;
};

}  // namespace spindrift
