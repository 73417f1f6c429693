/// @file
/// Samples of a pass that were stored before the service restarted.

#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "services/archive/stored_pass.h"

namespace spindrift {

/// Recognises samples that are stored already. After a restart a front-end sends its last minutes
/// again; such samples are not new and say nothing about the time of the pass.
class StoredSamples {
 public:
  explicit StoredSamples(const StoredPass& stored) {
    keys_.reserve(count_of(stored.values));
    stored.values.for_each([this](const auto& of_kind) {
      for (const auto& arrived : of_kind) {
        keys_.push_back(key_of(arrived.value, is_preferred(arrived.value)));
      }
    });
    std::sort(keys_.begin(), keys_.end());
  }

  /// Returns whether this sample is stored already. A sample of the preferred sender is new even if
  /// another sender gave the same values.
  template <class Value>
  bool hold(const Value& value) const {
    const auto holds = [&](bool preferred) {
      return std::binary_search(keys_.begin(), keys_.end(), key_of(value, preferred));
    };
    return holds(is_preferred(value)) || (!is_preferred(value) && holds(true));
  }

 private:
  /// Position of the sample in telemetry order, and a digest of its values: a sample with other
  /// values at the same position is new.
  using Key = std::pair<TelemetryOrder, std::size_t>;

  template <class Value>
  static bool is_preferred(const Value& value) {
    if constexpr (HasSender<Value>) {
      return value.sender == Sender::Preferred;
    }
    return false;
  }

  template <class Value>
  static Key key_of(const Value& value, bool preferred) {
    std::size_t digest = preferred ? 1 : 0;
    if constexpr (HasSender<Value>) {
      for_each_column(value, [&digest](std::string_view /*name*/, const auto& member) {
        constexpr std::size_t kOdd = 0x9e3779b97f4a7c15;
        digest = (digest ^ std::hash<std::remove_cvref_t<decltype(member)>>{}(member)) * kOdd;
      });
    }
    return {order_of(value), digest};
  }

  std::vector<Key> keys_;  ///< Keys in rising order.
};

}  // namespace spindrift
